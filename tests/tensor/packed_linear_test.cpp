// SPDX-License-Identifier: Apache-2.0
#include "osteon/tensor/packed_linear.h"

#include <bit>

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

// x W^T with all factors rounded to bf16 first, and sums in f32.
TEST(PackedLinear, in_bf16_is_that_of_rounded_factors) {
  if (!has_bf16()) GTEST_SKIP() << "this processor does not multiply bf16";
  Random random(5);
  const auto rounded = [](Matrix m) {
    for (float& value : m.reshaped()) {
      std::uint16_t upper = 0;
      to_bf16(&value, 1, &upper);
      value = std::bit_cast<float>(std::uint32_t{upper} << 16);
    }
    return m;
  };
  for (const Shape& s : {Shape{200, 64, 64}, {33, 1024, 256}, {127, 835, 64}, {1, 128, 128}}) {
    const Matrix x = random_matrix(s.rows, s.inputs, random), w = random_matrix(s.outputs, s.inputs, random);
    const std::vector<float> b = random_floats(s.outputs, random);
    const Matrix got = apply(PackedLinear(w, b, Activation::none, Precision::bf16), x);
    EXPECT_LE(test::relative_difference(got, loops::linear(Tensor(rounded(x)), rounded(w), b).matrix()), 1e-5f) << s.inputs;
    EXPECT_GT(test::relative_difference(got, loops::linear(Tensor(x), w, b).matrix()), 1e-5f) << "not bf16";
    for (Eigen::Index r = 0; r < x.rows(); r += 13)
      EXPECT_TRUE(test::same_bits(apply(PackedLinear(w, b, Activation::none, Precision::bf16), x.row(r)), got.row(r)));
  }
}

TEST(ToBf16, rounds_to_the_nearest_even) {
  const float values[] = {1.0f, -2.5f, 1.00390625f, 1.01171875f, 1.005f, 0.0f};  // the third and fourth lie between two bf16 numbers
  std::uint16_t upper[6];
  to_bf16(values, 6, upper);
  const float expected[] = {1.0f, -2.5f, 1.0f, 1.015625f, 1.0078125f, 0.0f};
  for (int i = 0; i < 6; ++i) EXPECT_EQ(std::bit_cast<float>(std::uint32_t{upper[i]} << 16), expected[i]);
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
