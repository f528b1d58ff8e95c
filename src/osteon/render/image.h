// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "osteon/base/types.h"

namespace osteon::render {

// A picture of 8-bit sRGB pixels, row-major, top row first.
struct Image {
  int width = 0, height = 0;
  std::vector<std::array<std::uint8_t, 3>> pixels;

  Image() = default;
  Image(int w, int h) : width(w), height(h), pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}

  auto& at(int x, int y) { return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)]; }
  const auto& at(int x, int y) const {
    return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  }
  bool operator==(const Image&) const = default;
};

// Linear light (0 black, 1 white; clamped) to an sRGB pixel: IEC 61966-2-1.
std::array<std::uint8_t, 3> encode_srgb(const Vec3f& linear);

// Copies `part` into `whole` with its left upper corner at (x, y). Pre: it fits.
void paste(Image& whole, const Image& part, int x, int y);

// Throws Error naming the file when it cannot be written.
void save_png(const std::filesystem::path& path, const Image& image);

}  // namespace osteon::render
