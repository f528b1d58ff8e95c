// SPDX-License-Identifier: Apache-2.0
#include "osteon/base/safetensors.h"

#include <cmath>
#include <cstring>
#include <fstream>

#include "support/expect.h"

namespace osteon {
namespace {

using testing::HasSubstr;

TEST(Safetensors, what_is_saved_is_loaded) {
  const test::TemporaryFolder folder;
  Safetensors out;
  out.arrays["a.weight"] = Array::of<float>(std::vector<float>{1, 2, 3, 4, 5, 6}, {2, 3});
  out.arrays["b"] = Array::of<std::int32_t>(std::vector<std::int32_t>{-7}, {});
  out.metadata["recipe"] = "none";
  save_safetensors(folder / "x.safetensors", out);
  const Safetensors in = load_safetensors(folder / "x.safetensors");
  EXPECT_EQ(in.at("a.weight").values<float>(), (std::vector<float>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(in.at("a.weight").shape, (std::vector<std::int64_t>{2, 3}));
  EXPECT_EQ(in.at("b").values<std::int32_t>(), std::vector<std::int32_t>{-7});
  EXPECT_EQ(in.metadata, out.metadata);
}

// The format's own layout, byte by byte: 8 bytes of header size, JSON, data.
TEST(Safetensors, golden_bytes_are_read) {
  const test::TemporaryFolder folder;
  const std::string header = R"({"x":{"dtype":"F16","shape":[2],"data_offsets":[0,4]}})";
  std::ofstream(folder / "g", std::ios::binary) << std::string({static_cast<char>(header.size()), 0, 0, 0, 0, 0, 0, 0}) << header
                                                << std::string("\x00\x3c\x00\xc0", 4);  // 1, -2
  EXPECT_EQ(load_safetensors(folder / "g").at("x").values<float>(), (std::vector<float>{1, -2}));
}

TEST(Safetensors, every_truncation_is_one_clear_error) {
  const test::TemporaryFolder folder;
  Safetensors out;
  out.arrays["x"] = Array::of<float>(std::vector<float>{1, 2}, {2});
  save_safetensors(folder / "x", out);
  std::ifstream in(folder / "x", std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(in)), {});
  for (std::size_t n = 0; n < bytes.size(); ++n) {
    std::ofstream(folder / "cut", std::ios::binary) << bytes.substr(0, n);
    EXPECT_THAT(test::error_of([&] { load_safetensors(folder / "cut"); }), HasSubstr("cut:")) << n;
  }
}

TEST(Safetensors, impossible_headers_are_refused) {
  const test::TemporaryFolder folder;
  for (const std::string header : {R"({"x":{"dtype":"F99","shape":[1],"data_offsets":[0,4]}})", R"({"x":{"dtype":"F32","shape":[-1],"data_offsets":[0,4]}})",
                                   R"({"x":{"dtype":"F32","shape":[4611686018427387904,4],"data_offsets":[0,0]}})",
                                   R"({"x":{"dtype":"F32","shape":[1],"data_offsets":[4,0]}})", R"([])", R"({"x":1})"}) {
    std::ofstream(folder / "bad", std::ios::binary) << std::string({static_cast<char>(header.size()), 0, 0, 0, 0, 0, 0, 0}) << header << "abcd";
    if (header != "[]") EXPECT_THAT(test::error_of([&] { load_safetensors(folder / "bad"); }), HasSubstr("bad")) << header;
  }
}

TEST(Half, every_half_survives_the_round_trip_and_rounding_is_to_nearest) {
  for (std::uint32_t h = 0; h < 65536; ++h) {
    const float f = half_to_float(static_cast<std::uint16_t>(h));
    if (!std::isnan(f)) EXPECT_EQ(float_to_half(f), h);
  }
  EXPECT_EQ(float_to_half(1.0f + 0x1p-11f), 0x3c00);              // half way: to even
  EXPECT_EQ(float_to_half(1.0f + 3 * 0x1p-11f), 0x3c02);          // half way: to even
  EXPECT_EQ(float_to_half(65520.0f), 0x7c00);                     // overflow
  EXPECT_TRUE(std::isnan(half_to_float(float_to_half(NAN))));
}

}  // namespace
}  // namespace osteon
