// SPDX-License-Identifier: Apache-2.0
#include "osteon/tensor/packed_linear.h"

#include "osteon/tensor/loops.h"
#include "support/expect.h"
#include "support/numbers.h"

namespace osteon::tensor {
namespace {

using test::random_floats;
using test::random_matrix;

Matrix apply(const PackedLinear& linear, const Matrix& x) {
  Tensor out(static_cast<std::size_t>(x.rows()), linear.outputs());
  linear(Tensor(x).data(), out.rows(), out.data());
  return out.matrix();
}

struct Shape {
  std::size_t rows, inputs, outputs;
};

// Heights around the tile's 64 and 128 and the tail's 16; widths of the networks, and odd ones.
const Shape shapes[] = {{1, 3, 64},   {15, 43, 128}, {16, 32, 32},  {64, 256, 256},  {127, 835, 64},
                        {129, 64, 5}, {300, 8, 32},  {200, 256, 1}, {33, 1024, 256}, {7, 1, 1}};

TEST(PackedLinear, equals_the_plain_loops) {
  Random random(1);
  for (const Shape& s : shapes) {
    const Matrix x = random_matrix(s.rows, s.inputs, random), w = random_matrix(s.outputs, s.inputs, random);
    const std::vector<float> b = random_floats(s.outputs, random);
    const Tensor expected = loops::linear(Tensor(x), w, b);
    EXPECT_LE(test::relative_difference(apply(PackedLinear(w, b, Activation::none), x), expected.matrix()), 1e-5f) << s.rows;
    EXPECT_LE(test::relative_difference(apply(PackedLinear(w, b, Activation::relu), x), loops::relu(expected).matrix()), 1e-5f) << s.rows;
  }
}

TEST(PackedLinear, a_row_does_not_depend_on_the_rows_around_it) {
  Random random(2);
  for (const Shape& s : shapes) {
    const PackedLinear linear(random_matrix(s.outputs, s.inputs, random), random_floats(s.outputs, random), Activation::none);
    const Matrix x = random_matrix(s.rows, s.inputs, random);
    const Matrix all = apply(linear, x);
    for (Eigen::Index r = 0; r < x.rows(); r += 13) EXPECT_TRUE(test::same_bits(apply(linear, x.row(r)), all.row(r))) << s.inputs;
  }
}

TEST(PackedLinear, without_a_bias_and_without_rows) {
  Random random(3);
  const Matrix w = random_matrix(4, 6, random);
  const PackedLinear linear(w, {}, Activation::none);
  const Matrix x = random_matrix(9, 6, random);
  EXPECT_LE(test::relative_difference(apply(linear, x), x * w.transpose()), 1e-5f);
  EXPECT_EQ(apply(linear, Matrix(0, 6)).rows(), 0);
}

}  // namespace
}  // namespace osteon::tensor
