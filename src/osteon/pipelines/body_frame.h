// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "osteon/mesh/triangle_mesh.h"

namespace osteon::pipelines {

enum class Up { automatic, y, z };  // automatic: y, or z where the character stands on the plane z = 0 (geometry/stance.h)

// The frame that a character is rigged in. It follows from the shape, not from how the file turns it: y up, and one side along +x. So a
// character turned by right angles, or given with another axis up, is the same to all that follows, bit by bit.
// The networks do not care about the front (they are shown both ways); names and joint axes do.
struct BodyFrame {
  Eigen::Matrix3f turn = Eigen::Matrix3f::Identity();  // world of the mesh -> body
  bool is_z_up = false;                                // of the mesh
  bool is_seen_from_behind = false;                    // the front is at -z of the body frame
};

// By right angles: up, and the finer side of the mesh to +z; the widest side along x where no side is finer.
BodyFrame body_frame(const TriangleMesh& mesh, Up up);

// The same with the normal of `symmetry`, found in the frame `before`, along x, where it is horizontal; empty when it was within 5 degrees.
// To be repeated: of a shape alike before and behind it may be the other of its two planes that now has its normal along x.
std::optional<BodyFrame> aligned(const BodyFrame& before, const Plane& symmetry, const TriangleMesh& mesh);

TriangleMesh turned(TriangleMesh mesh, const Eigen::Matrix3f& turn);

}  // namespace osteon::pipelines
