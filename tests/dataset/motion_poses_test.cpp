// SPDX-License-Identifier: Apache-2.0
#include "osteon/dataset/motion_poses.h"

#include <numbers>

#include "biped.h"
#include "capsule_character.h"
#include "osteon/dataset/articulate.h"
#include "support/expect.h"

namespace osteon::dataset {
namespace {

constexpr float kRightAngle = 0.5f * std::numbers::pi_v<float>;

Quatf about_z(float angle) { return Quatf(Eigen::AngleAxisf(angle, Vec3f::UnitZ())); }

// The capsule's own clip, in its file's frame: it bends in the middle by each of the angles.
Motion bending(const std::vector<float>& angles) {
  Motion motion;
  for (const float angle : angles) {
    Motion one = test::clip_of(test::capsule_character().skeleton, {{"middle", about_z(angle)}});
    one.poses.insert(one.poses.begin(), motion.poses.begin(), motion.poses.end());
    motion = std::move(one);
  }
  return motion;
}

TEST(OwnPose, the_rest_pose_of_a_clip_gives_the_rest_mesh) {
  const Articulation rest = own_pose(test::prepared_capsule(), bending({0.0f}), 0);
  for (JointId j : test::prepared_capsule().skeleton.names.ids())
    EXPECT_VEC3_NEAR(rest.joints[j], test::prepared_capsule().skeleton.rest_positions[j], 1e-5f);
  PreparedCharacter same = test::prepared_capsule();
  normalise_again(same);  // the reduced mesh fills its box a little less
  const PreparedCharacter posed = articulated(test::prepared_capsule(), rest);
  for (VertexId v : same.mesh.positions.ids()) EXPECT_VEC3_NEAR(posed.mesh.positions[v], same.mesh.positions[v], 1e-5f);
}

TEST(OwnPose, joints_stand_where_the_clip_has_them_and_bones_keep_their_lengths) {
  const Motion motion = bending({0.5f, kRightAngle});
  const Skeleton& rest = test::prepared_capsule().skeleton;
  for (std::size_t pose = 0; pose < 2; ++pose) {
    const Articulation a = own_pose(test::prepared_capsule(), motion, pose);
    for (JointId j : rest.names.ids())
      EXPECT_VEC3_NEAR(a.joints[j], test::prepared_capsule().normalization.apply(motion.poses[pose][index(j)].translation()), 1e-5f);
    for (const Bone& bone : bones(rest))
      if (bone.end) EXPECT_NEAR((a.joints[*bone.end] - a.joints[bone.start]).norm(), (bone.segment.b - bone.segment.a).norm(), 1e-5f);
  }
}

TEST(OwnPose, joints_that_the_clip_does_not_name_follow_the_joint_above) {
  Motion motion = bending({kRightAngle});
  const Articulation whole = own_pose(test::prepared_capsule(), motion, 0);
  motion.names[2] = "?";
  const Articulation without = own_pose(test::prepared_capsule(), motion, 0);
  EXPECT_VEC3_NEAR(without.joints[JointId{2}], whole.joints[JointId{2}], 1e-5f);
  EXPECT_TRUE(without.linear[JointId{2}].isApprox(whole.linear[JointId{2}], 1e-5f));
}

std::vector<Articulation> poses_of(const Motion& motion, std::size_t count) {
  MotionLibrary library;
  library.own["capsule"] = motion;
  Random random(1);
  return motion_poses(test::prepared_capsule(), library, count, random);
}

float bend_of(const Articulation& pose) {
  const Vec3f low = pose.joints[JointId{1}] - pose.joints[JointId{0}], high = pose.joints[JointId{2}] - pose.joints[JointId{1}];
  return std::acos(std::clamp(low.normalized().dot(high.normalized()), -1.0f, 1.0f));
}

TEST(MotionPoses, are_those_that_differ_most_from_the_rest_pose_and_from_one_another) {
  const auto poses = poses_of(bending({0.01f, 0.02f, 0.5f, 0.51f, 0.9f, 0.0f}), 2);
  ASSERT_EQ(poses.size(), 2u);
  EXPECT_NEAR(bend_of(poses[0]), 0.9f, 1e-3f);
  EXPECT_NEAR(bend_of(poses[1]), 0.5f, 2e-2f);
}

TEST(MotionPoses, those_that_do_not_differ_are_not_taken) { EXPECT_TRUE(poses_of(bending({0.0f, 0.0f}), 4).empty()); }

TEST(MotionPoses, of_a_body_that_lies_are_left_out_and_turns_about_y_are_undone) {
  const Quatf yaw(Eigen::AngleAxisf(1.0f, Vec3f::UnitY()));
  const Skeleton skeleton = test::capsule_character().skeleton;
  Motion motion = test::clip_of(skeleton, {{"low", about_z(kRightAngle)}});
  motion.poses.push_back(test::clip_of(skeleton, {{"low", yaw}, {"middle", about_z(0.4f)}}).poses[0]);
  const auto poses = poses_of(motion, 4);
  ASSERT_EQ(poses.size(), 1u);
  const auto straight = poses_of(bending({0.4f}), 4);
  for (JointId j : skeleton.names.ids())
    EXPECT_LT((poses[0].linear[j] - straight[0].linear[j]).norm(), 0.02f);  // up to what the bend itself turns the mean by
}

TEST(MotionPoses, that_shrink_a_part_to_nothing_are_left_out) {
  Motion motion = bending({0.4f, 0.8f});
  motion.poses[1][2].scale(0.01f);
  const auto poses = poses_of(motion, 4);
  ASSERT_EQ(poses.size(), 1u);
  EXPECT_NEAR(bend_of(poses[0]), 0.4f, 1e-3f);
}

TEST(MotionPoses, none_for_a_character_without_a_clip_that_is_no_biped) {
  MotionLibrary library;
  library.bipeds.push_back(test::clip_of(test::biped(false), {{"Spine", about_z(0.5f)}}));
  Random random(1);
  EXPECT_TRUE(motion_poses(test::prepared_capsule(), library, 4, random).empty());
}

}  // namespace
}  // namespace osteon::dataset
