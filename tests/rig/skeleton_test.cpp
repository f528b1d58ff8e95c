// SPDX-License-Identifier: Apache-2.0
#include "osteon/rig/skeleton.h"

#include <numbers>

#include "osteon/rig/pose.h"
#include "support/expect.h"

namespace osteon {
namespace {

using testing::HasSubstr;

// hip - spine - head; hip - leg
Skeleton small() {
  Skeleton s;
  const JointId hip = s.add("hip", std::nullopt, {0, 1, 0});
  const JointId spine = s.add("spine", hip, {0, 2, 0});
  s.add("leg", hip, {0.5f, 0, 0});
  s.add("head", spine, {0, 3, 0});
  return s;
}

TEST(Skeleton, bones_run_breadth_first_with_a_leaf_bone_after_each_leaf) {
  const auto list = bones(small());
  const std::vector<std::pair<int, int>> expected{{0, 1}, {0, 2}, {2, -1}, {1, 3}, {3, -1}};
  ASSERT_EQ(list.size(), expected.size());  // (joints - 1) + leaves
  for (std::size_t i = 0; i < list.size(); ++i) {
    EXPECT_EQ(index(list[i].start), static_cast<std::size_t>(expected[i].first));
    EXPECT_EQ(list[i].end ? static_cast<int>(index(*list[i].end)) : -1, expected[i].second);
  }
}

TEST(Skeleton, a_lone_joint_is_one_leaf_bone) {
  Skeleton s;
  s.add("only", std::nullopt, {1, 2, 3});
  ASSERT_EQ(bones(s).size(), 1u);
  EXPECT_EQ(bones(s)[0].segment.a, bones(s)[0].segment.b);
}

TEST(Skeleton, orientation_points_y_at_the_main_child) {
  Skeleton s = small();
  orient_along_bones(s);
  EXPECT_VEC3_NEAR(s.rest_orientations[JointId{0}] * Vec3f::UnitY(), Vec3f(0, 1, 0), 1e-6f);  // the spine has more descendants than the leg
  EXPECT_VEC3_NEAR(s.rest_orientations[JointId{0}] * Vec3f::UnitZ(), Vec3f(0, 0, 1), 1e-6f);
  EXPECT_TRUE(s.rest_orientations[JointId{2}].isApprox(s.rest_orientations[JointId{0}]));
  validate(s);
}

TEST(Skeleton, orientation_points_between_equal_children_unless_they_are_opposite) {
  Skeleton s;
  const JointId hip = s.add("hip", std::nullopt, {0, 1, 0});
  for (float side : {1.0f, -1.0f}) s.add(side > 0 ? "left" : "right", hip, {side * 0.3f, 0.5f, 0});
  orient_along_bones(s);
  EXPECT_VEC3_NEAR(s.rest_orientations[hip] * Vec3f::UnitY(), Vec3f(0, -1, 0), 1e-6f);
  for (JointId j : {JointId{1}, JointId{2}}) s.rest_positions[j].y() = 1.0f;
  orient_along_bones(s);
  EXPECT_TRUE(s.rest_orientations[hip].isApprox(Quatf::Identity()));
}

TEST(Skeleton, turning_it_turns_positions_and_axes) {
  Skeleton s = small();
  orient_along_bones(s);
  const Eigen::Matrix3f turn = Eigen::AngleAxisf(0.7f, Vec3f(1, 2, 3).normalized()).toRotationMatrix();
  const Skeleton t = turned(s, turn);
  validate(t);
  for (JointId j : s.names.ids()) {
    EXPECT_VEC3_NEAR(t.rest_positions[j], turn * s.rest_positions[j], 1e-6f);
    EXPECT_VEC3_NEAR(t.rest_orientations[j] * Vec3f::UnitY(), turn * (s.rest_orientations[j] * Vec3f::UnitY()), 1e-6f);
  }
}

TEST(Skeleton, validate_names_the_culprit) {
  Skeleton s = small();
  s.names[JointId{3}] = "leg";
  EXPECT_THAT(test::error_of([&] { validate(s); }), HasSubstr("joint 3 has the name 'leg'"));
  s = small();
  s.parents[JointId{1}].reset();
  EXPECT_THAT(test::error_of([&] { validate(s); }), HasSubstr("second root"));
  s = small();
  s.parents[JointId{1}] = JointId{3};
  EXPECT_THAT(test::error_of([&] { validate(s); }), HasSubstr("parents come before"));
}

TEST(Pose, the_rest_pose_moves_nothing) {
  const Skeleton s = small();
  for (const Transform& t : skinning_transforms(s, Pose::rest(s))) EXPECT_TRUE(t.isApprox(Transform::Identity()));
}

TEST(Pose, a_joint_turns_what_hangs_on_it_about_itself) {
  const Skeleton s = small();
  Pose pose = Pose::rest(s);
  pose.rotations[JointId{1}] = Eigen::AngleAxisf(std::numbers::pi_v<float> / 2, Vec3f::UnitZ());
  const auto posed = posed_positions(s, pose);
  EXPECT_VEC3_NEAR(posed[JointId{1}], Vec3f(0, 2, 0), 1e-6f);
  EXPECT_VEC3_NEAR(posed[JointId{3}], Vec3f(-1, 2, 0), 1e-6f);
  EXPECT_VEC3_NEAR(posed[JointId{2}], Vec3f(0.5f, 0, 0), 1e-6f);
}

}  // namespace
}  // namespace osteon
