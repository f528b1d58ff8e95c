// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/mesh/triangle_mesh.h"

// How a character stands in its file: what its bounding box and its modelling say of the up axis and of its front.
namespace osteon::geometry {

// Whether the character stands on the plane z = 0 of its file and not on y = 0: z is up then. Measured is how deep the box sinks into a
// plane, in parts of its height over it, 0 to 0.5: feet on the ground 0, flying 0, in the middle 0.5. True when the box sinks into z = 0 by
// less than 0.05 and into y = 0 by at least 0.15 more; so wherever there is doubt (a fish around the origin), y stays up.
// Only corners of faces count.
bool stands_along_z(const TriangleMesh& mesh);

// Horizontally, in parts of the longest side, y up: how far the middle of the faces, each counted once, lies from the middle of the
// surface, each counted by its area. Artists model faces, hands and toes finer than backs and heels: it points to the front of seven in
// eight characters. Zero for evenly modelled shapes, and without any area.
Vec3f finer_side(const TriangleMesh& mesh);

// The turn about y that takes a horizontal direction of unit length to +z; exact (0, 1 and -1 only) where the direction is an axis.
Eigen::Matrix3f turn_to_front(const Vec3f& direction);

// The turn that takes z up to y up, x staying where it is; exact.
Eigen::Matrix3f turn_z_up_to_y_up();

}  // namespace osteon::geometry
