// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "osteon/nets/dry_run.h"
#include "osteon/train/device_ops.h"
#include "osteon/train/fused_ops.h"
#include "synthetic.h"

namespace osteon::train {
namespace {

at::Tensor random_matrix(std::int64_t rows, std::int64_t columns, std::uint64_t seed) {
  Random random(seed);
  at::Tensor x = at::empty({rows, columns});
  for (std::int64_t i = 0; i < x.numel(); ++i) x.data_ptr<float>()[i] = random.normal();
  return x;
}

// Runs `layer` on both backends and compares values, running figures and the gradients of the input and of all parameters.
template <class Layer>
void expect_equal_layers(Layer layer) {
  nets::DryRun dry;
  layer(dry, nets::DryRun::Tensor{12}, nets::on_backend(dry, nets::MeshArrays{}));
  const auto run = [&]<class Backend>(std::type_identity<Backend>, Parameters& parameters, at::Tensor& input) {
    Backend backend = [&] {
      if constexpr (std::is_same_v<Backend, FusedOps>)
        return FusedOps(parameters, Mode::training);
      else
        return TorchOps(parameters, Mode::training, torch::kCPU);
    }();
    const at::Tensor out = layer(backend, input, nets::on_backend(backend, test::two_characters(30).mesh));
    (out * random_matrix(out.size(0), out.size(1), 9)).sum().backward();
    return out;
  };
  Parameters plain = initial_parameters(dry.parameters, 2);
  for (auto& [name, value] : plain)
    if (name.ends_with("norm.weight")) value = random_matrix(1, value.size(0), 4).squeeze(0);  // both signs: maxima become minima
  Parameters fused = plain;
  prepare_for_training(plain, at::kCPU);
  prepare_for_training(fused, at::kCPU);
  at::Tensor x1 = random_matrix(67, 12, 1).set_requires_grad(true), x2 = random_matrix(67, 12, 1).set_requires_grad(true);
  EXPECT_LT(test::difference(run(std::type_identity<FusedOps>(), fused, x2), run(std::type_identity<TorchOps>(), plain, x1)), 1e-5f);
  EXPECT_LT(test::difference(x2.grad(), x1.grad()), 1e-4f);
  for (const auto& [name, value] : plain)
    EXPECT_LT(is_trained(name) ? test::difference(fused.at(name).grad(), value.grad()) : test::difference(fused.at(name), value), 1e-4f)
        << name;
}

TEST(FusedLayers, edge_convolution_is_that_of_plain_operations) {
  expect_equal_layers([](auto& b, const auto& x, const auto& mesh) { return edge_conv(b, nets::Path("layer"), x, mesh.geodesic, 24); });
}

TEST(FusedLayers, mlp_over_parts_is_that_of_plain_operations) {
  expect_equal_layers([]<class B>(B& b, const typename B::Tensor& x, const nets::MeshGraph<B>& mesh) {
    const auto global = b.max_by(x, mesh.batch.offsets);
    return nets::mlp<B>(b, nets::Path("layer"), {{global, mesh.batch.mesh_of}, mesh.positions, x}, {20, 9});
  });
}

// Two rows share the first segment's largest value, three the second's; the gradients have both signs.
TEST(SharedSegmentMax, splits_the_gradient_among_equals) {
  at::Tensor x = at::tensor({1.0f, 4.0f, 4.0f, 7.0f, 7.0f, 7.0f}).view({6, 1}).set_requires_grad(true);
  const at::Tensor best = shared_segment_max(x, at::tensor({0, 3, 6}, at::kInt));
  (best * at::tensor({-2.0f, 3.0f}).view({2, 1})).sum().backward();
  EXPECT_TRUE(at::equal(best, at::tensor({4.0f, 7.0f}).view({2, 1})));
  EXPECT_TRUE(at::equal(x.grad(), at::tensor({0.0f, -1.0f, -1.0f, 1.0f, 1.0f, 1.0f}).view({6, 1})));
}

}  // namespace
}  // namespace osteon::train
