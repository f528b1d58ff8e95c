// SPDX-License-Identifier: Apache-2.0
#include "osteon/infer/parameters.h"

#include <limits>

#include "examples.h"
#include "support/expect.h"

namespace osteon::infer {
namespace {

using nets::Path;
using testing::HasSubstr;

const Shapes shapes{{"a.weight", {2, 3}}, {"a.bias", {2}}, {"norm.running_var", {2}}};

Safetensors fitting() {
  Safetensors out;
  out.arrays["a.weight"] = Array::of<float>(std::vector<float>{1, 2, 3, 4, 5, 6}, {2, 3});
  out.arrays["a.bias"] = Array::half(std::vector<float>{0.5f, -2}, {2});
  out.arrays["norm.running_var"] = Array::of<float>(std::vector<float>{1, 0}, {2});
  return out;
}

TEST(Parameters, float32_and_float16_are_read_row_by_row) {
  const Parameters parameters(fitting(), shapes, "file");
  EXPECT_EQ(parameters.at(Path("a.weight"))(1, 0), 4);
  EXPECT_EQ(parameters.at(Path("a.bias"))(0, 1), -2);
}

TEST(Parameters, every_difference_is_reported_at_once) {
  Safetensors content = fitting();
  content.arrays.erase("a.bias");
  content.arrays["a.weight"].shape = {3, 2};
  content.arrays["norm.running_var"] = Array::of<float>(std::vector<float>{1, -1}, {2});
  content.arrays["b.weight"] = Array::of<float>(std::vector<float>{1}, {1});
  const std::string error = test::error_of([&] { Parameters(content, shapes, "x.safetensors"); });
  EXPECT_THAT(error, HasSubstr("x.safetensors: 4 "));
  EXPECT_THAT(error, HasSubstr("a.bias: missing, expected (2)"));
  EXPECT_THAT(error, HasSubstr("a.weight: shape (3,2), expected (2,3)"));
  EXPECT_THAT(error, HasSubstr("norm.running_var: has negative variances"));
  EXPECT_THAT(error, HasSubstr("b.weight: (1) is no parameter"));
}

TEST(Parameters, numbers_must_be_finite_floats) {
  Safetensors content = fitting();
  content.arrays["a.bias"] = Array::of<float>(std::vector<float>{0, std::numeric_limits<float>::quiet_NaN()}, {2});
  EXPECT_THAT(test::error_of([&] { Parameters(content, shapes, "x"); }), HasSubstr("a.bias: has values that are not finite"));
  content.arrays["a.bias"] = Array::of<std::int32_t>(std::vector<std::int32_t>{0, 1}, {2});
  EXPECT_THAT(test::error_of([&] { Parameters(content, shapes, "x"); }), HasSubstr("a.bias: neither float32 nor float16"));
}

TEST(Parameters, a_layer_is_forgotten_by_its_name_and_no_other) {
  Parameters parameters(fitting(), shapes, "x");
  parameters.forget(Path("norm"));
  EXPECT_EQ(parameters.at(Path("a.weight")).size(), 6);
}

TEST(Parameters, a_missing_file_is_named) {
  EXPECT_THAT(test::error_of([] { load_parameters("/nowhere/joints.safetensors", shapes); }), HasSubstr("/nowhere/joints.safetensors"));
}

}  // namespace
}  // namespace osteon::infer
