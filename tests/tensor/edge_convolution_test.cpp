// SPDX-License-Identifier: Apache-2.0
#include "osteon/tensor/edge_convolution.h"

#include "osteon/tensor/loops.h"
#include "support/expect.h"
#include "support/numbers.h"

namespace osteon::tensor {
namespace {

using test::random_floats;
using test::random_matrix;
using test::ScopedThreads;

// A graph with a self loop at every vertex and 0..20 other edges into it.
struct Example {
  std::size_t vertices, inputs, width;
  Random random{11};
  std::vector<std::int32_t> offsets{0}, sources, receivers;
  Tensor x;
  EdgeConvolution::Weights weights;

  Example(std::size_t v, std::size_t c, std::size_t h) : vertices(v), inputs(c), width(h), x(random_matrix(v, c, random)) {
    for (std::size_t i = 0; i < v; ++i) {
      sources.push_back(static_cast<std::int32_t>(i));
      for (std::size_t k = random.below(21); k > 0; --k) sources.push_back(static_cast<std::int32_t>(random.below(v)));
      offsets.push_back(static_cast<std::int32_t>(sources.size()));
      receivers.resize(sources.size(), static_cast<std::int32_t>(i));
    }
    weights = {{random_matrix(2 * h, c, random), random_floats(2 * h, random)}, random_matrix(h, h, random), {}, random_floats(h, random)};
    for (std::size_t i = 0; i < h; ++i) weights.sign.push_back(i % 3 == 0 ? -1.0f : 1.0f);
  }
  EdgeList edges() const { return {offsets, sources, receivers}; }

  // Message by message, as the header's formula stands.
  Tensor by_loops() const {
    const Matrix zero_bias = Matrix::Zero(1, static_cast<Eigen::Index>(width));
    const Tensor ends = loops::linear(x, weights.ends.weights, weights.ends.bias);
    const Matrix all = ends.matrix();
    const auto h = static_cast<Eigen::Index>(width);
    const Tensor p(all.leftCols(h)), q(-all.rightCols(h));
    const Tensor hidden = loops::relu(loops::subtract(loops::rows(p, receivers), loops::rows(q, sources)));
    const Tensor messages = loops::linear(hidden, weights.messages, {zero_bias.data(), width});
    return loops::relu(loops::scale_shift(loops::max_by(messages, offsets), weights.sign, weights.shift));
  }
};

TEST(EdgeConvolution, equals_the_plain_loops_message_by_message) {
  for (const auto& [v, c, h] : {std::array<std::size_t, 3>{1, 3, 32}, {63, 3, 32}, {200, 64, 128}, {70, 128, 256}, {130, 5, 7}}) {
    const Example example(v, c, h);
    const Tensor got = EdgeConvolution(example.weights)(example.x, example.edges());
    EXPECT_LE(test::relative_difference(got.matrix(), example.by_loops().matrix()), 1e-5f) << v << " vertices, " << h << " wide";
  }
}

TEST(EdgeConvolution, the_same_bits_for_any_number_of_threads) {
  const Example example(500, 16, 64);
  const EdgeConvolution convolution(example.weights);
  auto run = [&](int n) {
    const ScopedThreads scope(n);
    return convolution(example.x, example.edges()).matrix();
  };
  const Matrix one = run(1);
  for (int n : {2, 4}) EXPECT_TRUE(test::same_bits(run(n), one));
}

TEST(EdgeConvolution, the_order_of_a_vertex_s_messages_does_not_matter) {
  Example example(150, 16, 64);
  const EdgeConvolution convolution(example.weights);
  const Matrix before = convolution(example.x, example.edges()).matrix();
  for (std::size_t v = 0; v < example.vertices; ++v)
    std::reverse(example.sources.begin() + example.offsets[v], example.sources.begin() + example.offsets[v + 1]);
  EXPECT_TRUE(test::same_bits(convolution(example.x, example.edges()).matrix(), before));
}

}  // namespace
}  // namespace osteon::tensor
