// SPDX-License-Identifier: Apache-2.0
#include <ATen/Parallel.h>
#include <gtest/gtest.h>
#include <torch/types.h>

#include "osteon/train/fused_ops.h"
#include "synthetic.h"

namespace osteon::train {
namespace {

struct Passed {
  at::Tensor value, gradient;
};

// A layer's value for seeded rows and the gradient of a seeded linear function of it.
template <class Layer>
Passed passed(const Layer& layer, std::int64_t rows, std::int64_t columns) {
  at::Tensor x = at::empty({rows, columns}), direction = at::empty({rows, columns});
  Random random(4);
  for (std::int64_t i = 0; i < x.numel(); ++i) {
    x.data_ptr<float>()[i] = random.normal();
    direction.data_ptr<float>()[i] = random.normal();
  }
  x.set_requires_grad(true);
  const at::Tensor y = layer(x);
  (y * direction).sum().backward();
  return {y.detach(), x.grad()};
}

float largest_difference(const at::Tensor& a, const at::Tensor& b) { return ((a - b).abs().max() / b.abs().max()).item<float>(); }

class GraphAttention : public ::testing::Test {
 protected:
  const NetworkInputs inputs = test::two_characters();
  const std::int64_t vertices = inputs.mesh.batch.rows();
  Parameters none;
  TorchOps plain{none, Mode::training, at::kCPU};
  const at::Tensor offsets = plain.index(inputs.mesh.ring.offsets), sources = plain.index(inputs.mesh.ring.sources);
};

TEST_F(GraphAttention, has_the_values_and_gradients_of_plain_operations) {
  for (const std::int64_t heads : {1, 3}) {
    const Passed a = passed([&](const at::Tensor& x) { return graph_attention(x, offsets, sources, heads); }, vertices, 48);
    const Passed b = passed([&](const at::Tensor& x) { return plain.attend(x, offsets, sources, static_cast<int>(heads)); }, vertices, 48);
    EXPECT_LT(largest_difference(a.value, b.value), 1e-5f);
    EXPECT_LT(largest_difference(a.gradient, b.gradient), 1e-5f);
  }
}

TEST_F(GraphAttention, the_mean_has_them_too) {
  const Passed a = passed([&](const at::Tensor& x) { return segment_mean(x, offsets, sources); }, vertices, 70);
  const Passed b = passed([&](const at::Tensor& x) { return plain.mean_of(x, offsets, sources); }, vertices, 70);
  EXPECT_LT(largest_difference(a.value, b.value), 1e-5f);
  EXPECT_LT(largest_difference(a.gradient, b.gradient), 1e-5f);
}

TEST_F(GraphAttention, gives_the_same_bytes_with_one_and_two_threads) {
  const auto both = [&](int threads) {
    at::set_num_threads(threads);
    const Passed heard = passed([&](const at::Tensor& x) { return graph_attention(x, offsets, sources, 3); }, vertices, 96);
    const Passed mean = passed([&](const at::Tensor& x) { return segment_mean(x, offsets, sources); }, vertices, 130);
    return std::vector{heard.value, heard.gradient, mean.value, mean.gradient};
  };
  const int before = at::get_num_threads();
  const auto one = both(1), two = both(2);
  at::set_num_threads(before);
  for (std::size_t i = 0; i < one.size(); ++i) EXPECT_TRUE(at::equal(one[i], two[i])) << i;
}

}  // namespace
}  // namespace osteon::train
