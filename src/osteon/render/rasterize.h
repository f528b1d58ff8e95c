// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "osteon/mesh/triangle_mesh.h"

namespace osteon::render {

constexpr std::uint32_t nothing = UINT32_MAX;

// What is seen at the centre of each pixel: the nearest face and its depth.
struct VisibilityBuffer {
  int width = 0, height = 0;
  std::vector<std::uint32_t> faces;  // row-major, top row first; `nothing` where the background shows
  std::vector<float> depths;         // towards the viewer: larger is nearer; -infinity where the background shows

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
};

// Draws faces from both sides. Corners are in pixels with z towards the viewer (Camera::project); a pixel's centre is at +0.5. Of two faces
// at one depth the first wins. A pixel on a shared edge belongs to exactly one of the two faces (fixed point, top-left rule).
VisibilityBuffer rasterize(const PerVertex<Vec3f>& corners, const PerFace<Triangle>& faces, int width, int height);

}  // namespace osteon::render
