// SPDX-License-Identifier: Apache-2.0
#include "osteon/dataset/retarget.h"

#include <numbers>

#include "biped.h"
#include "support/expect.h"

namespace osteon::dataset {
namespace {

using test::biped;
using test::clip_of;
using test::joint_of;

Quatf turn(float degrees, const Vec3f& axis) { return Quatf(Eigen::AngleAxisf(degrees * std::numbers::pi_v<float> / 180.0f, axis)); }

Vec3f way(const Skeleton& s, const PerJoint<Vec3f>& joints, std::string_view from, std::string_view to) {
  return (joints[joint_of(s, to)] - joints[joint_of(s, from)]).normalized();
}

const std::vector<std::pair<std::string_view, Quatf>> kStep{{"Spine", turn(20, Vec3f::UnitX())},
                                                            {"LeftUpLeg", turn(-50, Vec3f::UnitX())},
                                                            {"LeftLeg", turn(40, Vec3f::UnitX())},
                                                            {"RightArm", turn(-60, Vec3f::UnitY())},
                                                            {"RightForeArm", turn(30, Vec3f::UnitZ())}};

TEST(BipedJoints, are_found_by_name_and_place_in_the_tree) {
  const Skeleton s = biped(false);
  const BipedJoints joints = biped_joints(s);
  for (std::size_t b = 0; b < joints.size(); ++b) {
    if (kBipedJoints[b] == "Spine2") continue;  // it has none
    ASSERT_TRUE(joints[b]) << kBipedJoints[b];
    EXPECT_EQ(s.names[*joints[b]], kBipedJoints[b]);
  }
  EXPECT_FALSE(joints[3]);
}

TEST(BipedJoints, none_without_thighs) {
  Skeleton fish;
  fish.add("root", std::nullopt, Vec3f(0, 0, 0));
  fish.add("head", JointId{0}, Vec3f(0, 0, 1));
  EXPECT_EQ(biped_joints(fish), BipedJoints{});
  EXPECT_FALSE(retargeted(fish, clip_of(biped(false), {}), 0));
}

TEST(Retargeted, the_rest_pose_of_the_same_rest_is_the_rest_pose) {
  const Skeleton s = biped(false);
  const auto pose = retargeted(s, clip_of(s, {}), 0);
  ASSERT_TRUE(pose);
  for (JointId j : s.names.ids()) {
    EXPECT_TRUE(pose->linear[j].isIdentity(1e-5f));
    EXPECT_VEC3_NEAR(pose->joints[j], s.rest_positions[j], 1e-5f);
  }
}

TEST(Retargeted, to_the_same_skeleton_is_the_pose_itself) {
  const Skeleton s = biped(false);
  const Motion clip = clip_of(s, kStep);
  const auto pose = retargeted(s, clip, 0);
  ASSERT_TRUE(pose);
  for (JointId j : s.names.ids()) EXPECT_VEC3_NEAR(pose->joints[j], clip.poses[0][index(j)].translation(), 1e-5f);
}

TEST(Retargeted, limbs_point_as_in_the_clip_whatever_the_rest_pose_and_bones_keep_their_lengths) {
  const Skeleton in_t = biped(false), arms_down = biped(true);
  const Motion clip = clip_of(in_t, kStep);
  PerJoint<Vec3f> in_clip;
  for (const Transform& t : clip.poses[0]) in_clip.push_back(t.translation());
  const auto pose = retargeted(arms_down, clip, 0);
  ASSERT_TRUE(pose);
  for (const auto& [from, to] : {std::pair{"LeftArm", "LeftForeArm"},
                                 {"RightArm", "RightForeArm"},
                                 {"RightForeArm", "RightHand"},
                                 {"LeftUpLeg", "LeftLeg"},
                                 {"LeftLeg", "LeftFoot"}})
    EXPECT_VEC3_NEAR(way(arms_down, pose->joints, from, to), way(in_t, in_clip, from, to), 1e-4f);
  for (const Bone& bone : bones(arms_down))
    if (bone.end) EXPECT_NEAR((pose->joints[*bone.end] - pose->joints[bone.start]).norm(), (bone.segment.b - bone.segment.a).norm(), 1e-5f);
}

TEST(Retargeted, a_character_that_faces_elsewhere_does_the_same_where_it_faces) {
  const Skeleton s = biped(true);
  const Eigen::Matrix3f half_turn = turn(180, Vec3f::UnitY()).toRotationMatrix();
  const Motion clip = clip_of(biped(false), kStep);
  const auto pose = retargeted(s, clip, 0), turned_pose = retargeted(turned(s, half_turn), clip, 0);
  ASSERT_TRUE(pose && turned_pose);
  for (JointId j : s.names.ids()) EXPECT_VEC3_NEAR(turned_pose->joints[j], half_turn * pose->joints[j], 1e-4f);
}

TEST(Retargeted, joints_that_move_by_position_channels_lead_the_bones_above_them) {
  const Skeleton s = biped(false);
  Motion clip = clip_of(s, {});
  const JointId foot = joint_of(s, "LeftFoot");
  clip.poses[0][index(foot)].translation() = Vec3f(0.1f, 0.5f, -0.4f);  // behind the knee, though nothing turns
  const auto pose = retargeted(s, clip, 0);
  ASSERT_TRUE(pose);
  EXPECT_VEC3_NEAR(way(s, pose->joints, "LeftLeg", "LeftFoot"), Vec3f(0, 0, -1), 1e-4f);
}

TEST(Retargeted, too_few_joints_in_common_give_nothing) {
  const Skeleton s = biped(false);
  Motion clip = clip_of(s, kStep);
  for (std::size_t j = 0; j < clip.names.size(); ++j)
    if (clip.names[j].ends_with("Leg") || clip.names[j].ends_with("Arm") || clip.names[j].ends_with("Foot")) clip.names[j] = "?";
  EXPECT_FALSE(retargeted(s, clip, 0));
}

}  // namespace
}  // namespace osteon::dataset
