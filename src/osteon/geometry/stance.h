// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/mesh/triangle_mesh.h"

// How a character stands in its file: what its bounding box and its modelling say of the up axis and of its front.
namespace osteon::geometry {

// Whether the character stands on the plane y = 0 of its file or on z = 0, so that this axis is up. Measured is how deep the box sinks into
// a plane, in parts of its height over it, 0 to 0.5: feet on the ground 0, flying 0, in the middle 0.5. It stands on a plane when the box
// sinks into it by less than 0.05 and into the other by at least 0.15 more; what lies around the origin (a fish) or touches both is
// unclear. Only corners of faces count.
enum class Stance { on_y, on_z, unclear };
Stance stance(const TriangleMesh& mesh);

// Horizontally, in parts of the longest side, y up: how far the middle of the faces, each counted once, lies from the middle of the
// surface, each counted by its area. Artists model faces, hands and toes finer than backs and heels: it points to the front of seven in
// eight characters. Zero for evenly modelled shapes, and without any area.
Vec3f finer_side(const TriangleMesh& mesh);

// The turn about y that takes a horizontal direction of unit length to +z; exact (0, 1 and -1 only) where the direction is an axis.
Eigen::Matrix3f turn_to_front(const Vec3f& direction);

// The turn that takes z up to y up, x staying where it is; exact.
Eigen::Matrix3f turn_z_up_to_y_up();

}  // namespace osteon::geometry
