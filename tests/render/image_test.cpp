// SPDX-License-Identifier: Apache-2.0
#include "osteon/render/image.h"

#include <png.h>

#include "support/expect.h"

namespace osteon::render {
namespace {

using testing::HasSubstr;

TEST(Image, srgb_is_that_of_the_standard) {
  const auto level = [](float linear) { return static_cast<int>(encode_srgb(Vec3f::Constant(linear))[0]); };
  EXPECT_EQ(level(0), 0);
  EXPECT_EQ(level(1), 255);
  EXPECT_EQ(level(0.2140f), 127);  // half grey: (128/255)^2.4 and a bit
  EXPECT_EQ(level(-1), 0);
  EXPECT_EQ(level(7), 255);
}

TEST(Image, a_png_gives_back_its_pixels) {
  Image image(3, 2);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] = {static_cast<std::uint8_t>(40 * i), static_cast<std::uint8_t>(i), 7};
  const test::TemporaryFolder folder;
  save_png(folder / "a.png", image);

  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  ASSERT_TRUE(png_image_begin_read_from_file(&header, (folder / "a.png").c_str()));
  header.format = PNG_FORMAT_RGB;
  Image back(static_cast<int>(header.width), static_cast<int>(header.height));
  ASSERT_TRUE(png_image_finish_read(&header, nullptr, back.pixels.data(), 0, nullptr));
  EXPECT_EQ(back, image);
}

TEST(Image, a_file_that_cannot_be_written_is_named) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(test::error_of([&] { save_png(folder / "none/a.png", Image(1, 1)); }), HasSubstr("none/a.png: cannot write the picture"));
}

TEST(Image, paste_puts_the_part_in_its_place) {
  Image whole(4, 3), part(2, 1);
  part.at(1, 0) = {1, 2, 3};
  paste(whole, part, 2, 1);
  EXPECT_EQ(whole.at(3, 1), (std::array<std::uint8_t, 3>{1, 2, 3}));
  EXPECT_EQ(whole.at(1, 1), (std::array<std::uint8_t, 3>{0, 0, 0}));
}

}  // namespace
}  // namespace osteon::render
