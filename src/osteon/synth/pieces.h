// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "osteon/mesh/triangle_mesh.h"

// Plain closed meshes for the pieces of a body, in world space, facing outwards.
namespace osteon::synth {

TriangleMesh block(const Vec3f& centre, const Vec3f& size);
TriangleMesh ball(const Vec3f& centre, float radius, int subdivisions = 2);

struct Ring {
  Vec3f centre;
  float width, depth;  // half of each, metres: along the side direction, and across it
};
// A tube through the rings with flat ends: 4 corners make beams (width and depth reach to their sides), many make cylinders and cones.
// `side` need not be at right angles to the axis; it must not be parallel to it.
TriangleMesh tube(const std::vector<Ring>& rings, int corners, const Vec3f& side = Vec3f::UnitX());

}  // namespace osteon::synth
