// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace osteon::skin {

enum class Side { none, left, right };
Side opposite(Side side);

// What a joint is by its name, whatever convention the name follows.
struct BoneName {
  std::string kind;  // such as "upperarm", "index.2", "thigh.twist", "control"; empty where nothing is left of the name ("Bone.012")
  Side side = Side::none;

  bool operator==(const BoneName&) const = default;
};

// "mixamorig:LeftUpLeg", "Bip01 L Thigh", "thigh_l", "UpperLeg.L" -> {"thigh", left}; "spine_02", "Spine2" -> {"spine.2", none}. Words for
// one part of the body are one kind; what is left of names that are no such word stays as it is. Numbers beyond 4 count as 4.
BoneName bone_name(std::string_view joint);

}  // namespace osteon::skin
