// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/joint_set.h"

#include "support/expect.h"

namespace osteon::pipelines {
namespace {

const std::vector<Vec3f> kJoints{{0.001f, 0.5f, 0}, {0.3f, 0.5f, 0}, {-0.302f, 0.5f, 0}, {0.2f, 0.1f, 0}};

TEST(JointSetOf, finds_partners_that_are_nearly_mirror_images) {
  const JointSet joints = joint_set_of(kJoints, Plane{Vec3f::UnitX(), 0.0f});
  EXPECT_EQ(joints.partner[0], 0u);
  EXPECT_EQ(joints.partner[1], 2u);
  EXPECT_EQ(joints.partner[2], 1u);
  EXPECT_FALSE(joints.partner[3].has_value());
}

TEST(JointSetOf, keeps_the_places_and_knows_no_partners_without_a_plane) {
  const JointSet joints = joint_set_of(kJoints, std::nullopt);
  EXPECT_EQ(joints.normalised(), kJoints);
  for (const auto& partner : joints.partner) EXPECT_FALSE(partner.has_value());
}

TEST(JointSetOf, works_across_any_plane) {
  const Plane plane{Vec3f(1, 0, 2).normalized(), 0.1f};
  const Vec3f p(0.4f, 0.2f, 0.1f);
  const std::vector<Vec3f> pair{p, plane.mirror(p)};
  const JointSet joints = joint_set_of(pair, plane);
  EXPECT_EQ(joints.partner[0], 1u);
  EXPECT_VEC3_NEAR(joints.normalised()[1], pair[1], 1e-5f);
}

}  // namespace
}  // namespace osteon::pipelines
