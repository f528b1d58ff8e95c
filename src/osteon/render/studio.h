// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/base/types.h"

// The light of the pictures: a warm key light from the upper left, a cool sky, light back from the ground, a rim. Fixed to the viewer, so
// that every view of a character is lit alike. Directions are in the axes of the view: x right, y up, z towards the viewer.
namespace osteon::render::studio {

Vec3f to_key_light();  // unit length

// Linear light from a surface of the given colour and unit normal; `ambient` and `key` (0..1) say how much of the light around and of the
// key light reaches it.
Vec3f shade(const Vec3f& color, const Vec3f& normal, float ambient, float key);

// The background at a height in the picture, 0 top .. 1 bottom, where a shadow of the given darkness (0..1) falls on it.
Vec3f backdrop(float height, float darkness);

}  // namespace osteon::render::studio
