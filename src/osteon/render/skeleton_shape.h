// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/mesh/triangle_mesh.h"
#include "osteon/rig/skeleton.h"

namespace osteon::render {

struct ColoredMesh {
  TriangleMesh mesh;
  PerVertex<Vec3f> colors;  // linear light
};

// The skeleton as animators know it: a slender octahedron for each bone, its thick end at the parent joint, and a ball at each joint in the
// joint's colour. `positions` are the joints in the pose to be shown; `thickness` is the largest radius of a ball, metres (smaller where
// bones are short: fingers).
ColoredMesh skeleton_shape(const Skeleton& skeleton, const PerJoint<Vec3f>& positions, const PerJoint<Vec3f>& joint_colors,
                           float thickness);

}  // namespace osteon::render
