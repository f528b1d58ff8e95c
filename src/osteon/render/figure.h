// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "osteon/render/camera.h"
#include "osteon/render/image.h"
#include "osteon/render/skeleton_shape.h"

namespace osteon::render {

// Which part of the studio's backdrop the image shows, from 0 (its top) to 1: several images make one picture.
struct Backdrop {
  float top = 0, bottom = 1;
};

// One thing to be drawn: a surface, and what is seen through it.
struct Figure {
  const TriangleMesh& mesh;
  const PerVertex<Vec3f>& colors;        // linear light
  const ColoredMesh* overlay = nullptr;  // a skeleton's shape, visible through the surface; may be null
  Backdrop backdrop = {};
};

// Draws the figure on a studio background with its shadow on the ground (the lowest point of the mesh). `camera` is in pixels of the image;
// its axes must be those of a view from the level or above. The bytes do not depend on the number of threads.
Image draw(const Figure& figure, const Camera& camera, int width, int height);

}  // namespace osteon::render
