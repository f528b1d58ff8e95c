// SPDX-License-Identifier: Apache-2.0
#include "osteon/tensor/packed_mlp.h"

#include "osteon/tensor/loops.h"
#include "support/expect.h"
#include "support/numbers.h"

namespace osteon::tensor {
namespace {

using test::random_floats;
using test::random_matrix;
using test::ScopedThreads;

// Three meshes of 100, 1 and 150 rows; columns: 3 of the row, 8 of its mesh, 20 of the row, 4 of a row out of ten. Layers 35 -> 70 -> 6.
struct Segments {
  static constexpr std::size_t rows = 251;
  Random random{7};
  std::vector<std::int32_t> offsets{0, 100, 101, 251}, mesh_of, partner;
  Tensor own{random_matrix(rows, 3, random)}, of_mesh{random_matrix(3, 8, random)}, more{random_matrix(rows, 20, random)},
      of_partner{random_matrix(10, 4, random)};
  std::vector<DenseLayer> layers{{random_matrix(70, 35, random), random_floats(70, random), Activation::relu},
                                 {random_matrix(6, 70, random), random_floats(6, random), Activation::relu}};

  Segments() {
    for (std::size_t s = 0; s + 1 < offsets.size(); ++s)
      mesh_of.resize(static_cast<std::size_t>(offsets[s + 1]), static_cast<std::int32_t>(s));
    for (std::size_t r = 0; r < rows; ++r) partner.push_back(static_cast<std::int32_t>(random.below(10)));
  }
  std::vector<InputColumns> input() const { return {{own, {}}, {of_mesh, mesh_of}, {more, {}}, {of_partner, partner}}; }
  PackedMlp packed() const {
    const PackedMlp::Block blocks[] = {{3, Reading::own_row}, {8, Reading::picked_row}, {20, Reading::own_row}, {4, Reading::picked_row}};
    return PackedMlp(blocks, layers);
  }
  Tensor by_loops() const {
    const Tensor parts[] = {own, loops::rows(of_mesh, mesh_of), more, loops::rows(of_partner, partner)};
    Tensor x = loops::concat(parts);
    for (const DenseLayer& layer : layers) x = loops::relu(loops::linear(x, layer.weights, layer.bias));
    return x;
  }
};

TEST(PackedMlp, equals_the_plain_loops_over_the_columns_side_by_side) {
  const Segments example;
  EXPECT_LE(test::relative_difference(example.packed()(example.input(), Segments::rows).matrix(), example.by_loops().matrix()), 1e-5f);
}

TEST(PackedMlp, maximum_of_each_segment_after_a_normalisation_that_may_fall) {
  const Segments example;
  const std::vector<float> scale{1, -1, 0, 2, -0.5f, 3}, shift{0, 1, 2, -1, 0, 0.5f};
  const Tensor expected = loops::max_by(loops::scale_shift(example.by_loops(), scale, shift), example.offsets);
  const Tensor got = example.packed().max_by(example.input(), example.offsets, scale, shift);
  EXPECT_LE(test::relative_difference(got.matrix(), expected.matrix()), 1e-5f);
}

TEST(PackedMlp, an_input_of_picked_columns_alone) {
  Random random(8);
  const Tensor values(random_matrix(5, 12, random));
  const std::vector<std::int32_t> picked{4, 0, 0, 3, 2, 1, 4};
  const DenseLayer layer{random_matrix(9, 12, random), random_floats(9, random), Activation::none};
  const PackedMlp::Block block{12, Reading::picked_row};
  const InputColumns input{values, picked};
  const Tensor expected = loops::linear(loops::rows(values, picked), layer.weights, layer.bias);
  EXPECT_LE(test::relative_difference(PackedMlp({&block, 1}, {&layer, 1})({&input, 1}, picked.size()).matrix(), expected.matrix()), 1e-5f);
}

TEST(PackedMlp, the_same_bits_for_any_number_of_threads) {
  const Segments example;
  const std::vector<float> scale(6, -1.0f), shift(6, 0.25f);
  const PackedMlp mlp = example.packed();
  auto run = [&](int n) {
    const ScopedThreads scope(n);
    return std::pair(mlp(example.input(), Segments::rows).matrix(), mlp.max_by(example.input(), example.offsets, scale, shift).matrix());
  };
  const auto [rows, maxima] = run(1);
  for (int n : {2, 4}) {
    EXPECT_TRUE(test::same_bits(run(n).first, rows));
    EXPECT_TRUE(test::same_bits(run(n).second, maxima));
  }
}

}  // namespace
}  // namespace osteon::tensor
