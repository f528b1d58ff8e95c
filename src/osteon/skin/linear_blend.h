// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/rig/pose.h"
#include "osteon/rig/rig.h"

namespace osteon::skin {

// Linear blend skinning: where the vertices of a rig stand in a pose, world space. v' = sum_j w_vj M_j v, M_j from rest to pose
// (Magnenat-Thalmann, Laperriere, Thalmann. Joint-dependent local deformations. 1988). Pre: validate(rig) holds; the pose has a rotation
// for every joint.
PerVertex<Vec3f> skin(const Rig& rig, const Pose& pose);

// The same from the joints' transforms (skinning_transforms), for one character in many poses.
PerVertex<Vec3f> skin(const PerVertex<Vec3f>& positions, const SkinWeights& weights, const PerJoint<Transform>& transforms);

}  // namespace osteon::skin
