// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/rig/skeleton.h"

namespace osteon {

// How far a skeleton is turned away from its rest pose. Rotations are about the joint, in world axes of the rest pose, before the parent's:
// the global transform of a joint is M_j = M_parent * T(p_j) R_j T(-p_j), whatever its rest orientation.
struct Pose {
  PerJoint<Quatf> rotations;
  Vec3f root_translation = Vec3f::Zero();  // metres

  static Pose rest(const Skeleton& skeleton) { return {PerJoint<Quatf>(skeleton.size(), Quatf::Identity())}; }
};

// Rest-pose world space -> posed world space, for each joint: what linear blend skinning multiplies vertices with.
PerJoint<Transform> skinning_transforms(const Skeleton& skeleton, const Pose& pose);

// Where the joints stand in the pose, world space.
PerJoint<Vec3f> posed_positions(const Skeleton& skeleton, const Pose& pose);

}  // namespace osteon
