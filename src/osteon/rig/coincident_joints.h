// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/rig/skeleton.h"

namespace osteon {

// A skeleton in which no joint stands where its parent or a sibling does.
struct MergedSkeleton {
  Skeleton skeleton;                // each joint as the first of those that it stands for
  PerJoint<JointId> from_original;  // original joint -> joint of `skeleton`
};

// Joints nearer than `distance` to their parent or an earlier sibling become one with it: artists stack control joints at one place, which
// no method can tell apart from the shape. The name, place and axes of the first joint stay; children go to the merged joint.
MergedSkeleton merge_coincident_joints(const Skeleton& skeleton, float distance);

}  // namespace osteon
