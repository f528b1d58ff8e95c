// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "osteon/rig/coincident_joints.h"
#include "osteon/rig/rig.h"

namespace osteon::dataset {

using osteon::merge_coincident_joints;
using osteon::MergedSkeleton;

// Skin weights at `points`, which lie on or near the surface of `original`: those of the closest surface point, blended between the corners
// of its face by barycentric coordinates. `to_joint` renames the joints. Pre: one row of `weights` per vertex of `original`.
SkinWeights weights_at(std::span<const Vec3f> points, const TriangleMesh& original, const SkinWeights& weights,
                       const PerJoint<JointId>& to_joint);

}  // namespace osteon::dataset
