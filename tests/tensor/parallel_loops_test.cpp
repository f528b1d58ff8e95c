// SPDX-License-Identifier: Apache-2.0
#include "osteon/tensor/parallel_loops.h"

#include <cmath>

#include "osteon/tensor/loops.h"
#include "support/expect.h"
#include "support/numbers.h"

namespace osteon::tensor {
namespace {

struct Graph {
  std::vector<std::int32_t> offsets{0}, sources;
};

// Every vertex hears itself and up to `most` others.
Graph any_graph(std::size_t vertices, std::size_t most, Random& random) {
  Graph g;
  for (std::size_t v = 0; v < vertices; ++v) {
    g.sources.push_back(static_cast<std::int32_t>(v));
    for (std::size_t k = random.below(most + 1); k > 0; --k) g.sources.push_back(static_cast<std::int32_t>(random.below(vertices)));
    g.offsets.push_back(static_cast<std::int32_t>(g.sources.size()));
  }
  return g;
}

Tensor any_tensor(std::size_t rows, std::size_t columns, Random& random) {
  Tensor out(rows, columns);
  for (std::size_t i = 0; i < rows * columns; ++i) out.data()[i] = random.normal();
  return out;
}

TEST(GraphAttention, a_vertex_without_neighbours_hears_itself) {
  Random random(1);
  const Tensor x = any_tensor(3, 32, random);
  const std::vector<std::int32_t> offsets{0, 1, 2, 3}, sources{0, 1, 2};
  EXPECT_TRUE(test::same_bits(attend(x, offsets, sources, 2).matrix(), x.matrix()));
  EXPECT_TRUE(test::same_bits(mean_of(x, offsets, sources).matrix(), x.matrix()));
}

// x0 = (1, 0, ...), x1 = (0, 2, ...): scores of vertex 0 are 1 and 0, of vertex 1 0 and 4.
TEST(GraphAttention, shares_are_the_softmax_of_the_dot_products) {
  Matrix numbers = Matrix::Zero(2, 16);
  numbers(0, 0) = 1.0f;
  numbers(1, 1) = 2.0f;
  const std::vector<std::int32_t> offsets{0, 2, 4}, sources{0, 1, 0, 1};
  const Matrix y = attend(Tensor(numbers), offsets, sources, 1).matrix();
  EXPECT_NEAR(y(0, 0), std::exp(1.0f) / (std::exp(1.0f) + 1.0f), 1e-6f);
  EXPECT_NEAR(y(0, 1), 2.0f / (std::exp(1.0f) + 1.0f), 1e-6f);
  EXPECT_NEAR(y(1, 1), 2.0f * std::exp(4.0f) / (std::exp(4.0f) + 1.0f), 1e-6f);
}

TEST(GraphAttention, scores_of_any_size_give_numbers) {
  Matrix numbers = Matrix::Constant(2, 16, 1e3f);
  numbers.row(1) *= -1.0f;
  const std::vector<std::int32_t> offsets{0, 2, 4}, sources{0, 1, 0, 1};
  EXPECT_TRUE(test::same_bits(attend(Tensor(numbers), offsets, sources, 1).matrix(), numbers));
}

TEST(ParallelLoops, of_attention_equal_the_plain_loops_and_the_same_bits_for_any_number_of_threads) {
  Random random(2);
  const Graph g = any_graph(300, 9, random);
  const Tensor x = any_tensor(300, 96, random);
  const auto both = [&](int n) {
    const test::ScopedThreads scope(n);
    return std::pair(attend(x, g.offsets, g.sources, 3).matrix(), mean_of(x, g.offsets, g.sources).matrix());
  };
  const auto [heard, mean] = both(1);
  EXPECT_LE(test::relative_difference(heard, loops::attend(x, g.offsets, g.sources, 3).matrix()), 1e-5f);
  EXPECT_LE(test::relative_difference(mean, loops::mean_of(x, g.offsets, g.sources).matrix()), 1e-5f);
  for (const int n : {2, 4}) {
    EXPECT_TRUE(test::same_bits(both(n).first, heard));
    EXPECT_TRUE(test::same_bits(both(n).second, mean));
  }
}

// Segments of any length from one row to many; scales of either sign, so that the largest is not always that of the largest number.
TEST(ParallelLoops, equal_the_plain_loops_for_any_number_of_threads) {
  Random random(3);
  const Tensor x = any_tensor(700, 37, random);
  const Graph g = any_graph(700, 9, random);
  std::vector<std::int32_t> offsets{0};
  while (offsets.back() < 700) offsets.push_back(std::min(700, offsets.back() + 1 + static_cast<std::int32_t>(random.below(90))));
  std::vector<float> scale, shift;
  for (int c = 0; c < 37; ++c) {
    scale.push_back(random.normal());
    shift.push_back(random.normal());
  }
  for (const int n : {1, 2, 4}) {
    const test::ScopedThreads scope(n);
    EXPECT_TRUE(test::same_bits(relu(x).matrix(), loops::relu(x).matrix()));
    EXPECT_TRUE(test::same_bits(rows(x, g.sources).matrix(), loops::rows(x, g.sources).matrix()));
    EXPECT_LE(test::relative_difference(scale_shift(x, scale, shift).matrix(), loops::scale_shift(x, scale, shift).matrix()), 1e-6f);
    EXPECT_LE(test::relative_difference(max_by(x, offsets, scale, shift).matrix(),
                                        loops::max_by(loops::scale_shift(x, scale, shift), offsets).matrix()),
              1e-6f);
  }
}

}  // namespace
}  // namespace osteon::tensor
