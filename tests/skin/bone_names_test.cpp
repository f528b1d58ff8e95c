// SPDX-License-Identifier: Apache-2.0
#include "osteon/skin/bone_names.h"

#include "support/expect.h"

namespace osteon::skin {

void PrintTo(const BoneName& name, std::ostream* out) {
  *out << name.kind << (name.side == Side::left ? ", left" : name.side == Side::right ? ", right" : "");
}

namespace {

TEST(BoneNames, one_part_of_the_body_has_one_kind_in_every_convention) {
  for (const char* thigh :
       {"mixamorig:LeftUpLeg", "Bip01 L Thigh", "thigh_l", "UpperLeg.L", "Armature_UpperLeg_L", "char:def_l_thigh", "LeftUpLeg"})
    EXPECT_EQ(bone_name(thigh), (BoneName{"thigh", Side::left})) << thigh;
  for (const char* forearm : {"RightForeArm", "Bip01 R Forearm", "lowerarm_r", "LowerArm.R", "char:def_r_elbow"})
    EXPECT_EQ(bone_name(forearm), (BoneName{"forearm", Side::right})) << forearm;
  for (const char* spine : {"spine_02", "Spine2", "Bip01 Spine2", "char:def_c_spineB"})
    EXPECT_EQ(bone_name(spine), (BoneName{"spine.2", Side::none})) << spine;
  for (const char* finger : {"Bip01 L Finger11", "Index2.L", "index_02_l", "LeftHandIndex2", "char:def_l_fngIndexB"})
    EXPECT_EQ(bone_name(finger), (BoneName{"index.2", Side::left})) << finger;
}

TEST(BoneNames, joints_that_are_no_part_of_the_body_say_so) {
  EXPECT_EQ(bone_name("IKFrontLeg.L").kind, "control");
  EXPECT_EQ(bone_name("PoleTarget_knee_r").kind, "control");
  EXPECT_EQ(bone_name("HeadTop_End").kind, "headtop.end");
  EXPECT_EQ(bone_name("upperarm_twist_01_l"), (BoneName{"upperarm.1.twist", Side::left}));
}

TEST(BoneNames, names_that_say_nothing_have_no_kind) {
  for (const char* name : {"Bone", "Bone.012", "joint1", "Armature_Bone_007", "", "...", "42"}) EXPECT_EQ(bone_name(name).kind, "") << name;
}

}  // namespace
}  // namespace osteon::skin
