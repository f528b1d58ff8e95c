// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "osteon/dataset/articulation.h"
#include "osteon/rig/motion.h"

namespace osteon::dataset {

// The joints that clips of bipeds and characters have in common, by Mixamo's names.
inline constexpr std::array<std::string_view, 22> kBipedJoints{
    "Hips",        "Spine",       "Spine1",        "Spine2",   "Neck",         "Head",        "LeftShoulder", "LeftArm",
    "LeftForeArm", "LeftHand",    "RightShoulder", "RightArm", "RightForeArm", "RightHand",   "LeftUpLeg",    "LeftLeg",
    "LeftFoot",    "LeftToeBase", "RightUpLeg",    "RightLeg", "RightFoot",    "RightToeBase"};

using BipedJoints = std::array<std::optional<JointId>, kBipedJoints.size()>;

// Which joints of a skeleton these are, told by their names (skin/bone_names.h) and by the tree: the hips are where the legs meet, and the
// joints between hips and neck are spread over the three of the spine. All empty where the skeleton has not two thighs.
BipedJoints biped_joints(const Skeleton& skeleton);

// A pose of another biped: each joint in common turns as far as in the clip from its rest pose, in the frame that faces forwards in both
// (clips face +z; characters so that what is named left is on their left). Thighs, calves and both parts of the arms point where they
// point in the clip, whatever rest poses both have; hands follow their forearm's rest pose. All other joints follow the joint above. Bones
// keep their lengths; the root stays where it is. `motion`: joints named as in kBipedJoints; others are not read.
// Empty where fewer than 12 joints are in common. Pre: pose < motion.poses.size().
std::optional<Articulation> retargeted(const Skeleton& skeleton, const Motion& motion, std::size_t pose);

}  // namespace osteon::dataset
