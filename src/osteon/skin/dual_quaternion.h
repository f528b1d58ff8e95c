// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/rig/pose.h"
#include "osteon/rig/rig.h"

namespace osteon::skin {

// Dual quaternion skinning: Kavan, Collins, Zara, O'Sullivan. Skinning with Dual Quaternions. I3D 2007, algorithm 1. Volume stays where
// linear blend skinning loses it (twisted wrists). Transforms are rigid; of opposite quaternions the one nearer to the largest influence's
// is taken. Pre: validate(rig) holds; the pose has a rotation for every joint.
PerVertex<Vec3f> skin_dual_quaternion(const Rig& rig, const Pose& pose);
PerVertex<Vec3f> skin_dual_quaternion(const PerVertex<Vec3f>& positions, const SkinWeights& weights, const PerJoint<Transform>& transforms);

}  // namespace osteon::skin
