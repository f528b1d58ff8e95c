// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "osteon/rig/skeleton.h"

namespace osteon::pipelines {

enum class HandPart { wrist, thumb, index, middle, ring, pinky };
constexpr std::array<std::string_view, 6> kHandPartNames{"hand", "thumb", "index", "middle", "ring", "pinky"};

// A readable name for every joint, after its place alone: "root", then "<chain>_<number>" from the root outwards, the chain being
// - "spine": the longest chain in the middle that leaves the root and does not go backwards or down; "tail": one that goes backwards;
//   "centre": any other in the middle;
// - "left_leg", "right_leg": leaves the middle and reaches the lowest quarter of the skeleton; "…_arm": leaves the upper half of the middle
//   and is at least 0.15 high or wide; "…_limb": any other (fins, ears, jaws);
// - "left_hand" (without a number), "left_thumb", "left_index", ...: a joint of a known part of a hand;
// - "<chain>_branch": leaves a chain on a side otherwise.
// A second chain of a name is "left_leg2", and so on. Mirror partners differ in left/right only. Sides: by `partner` where there is one
// (itself: middle), else by x against the root's, 0.02 being the middle. `part`: what it is of a hand, where that is known; empty: of none.
// Not a claim about anatomy: named skeletons come by templates. Pre: names are not read; positions are in a frame with y up, facing +z,
// longest side about 1, symmetry plane x = 0.
PerJoint<std::string> joint_names(const Skeleton& skeleton, const PerJoint<std::optional<JointId>>& partner,
                                  const PerJoint<std::optional<HandPart>>& part = {});

}  // namespace osteon::pipelines
