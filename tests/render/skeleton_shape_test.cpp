// SPDX-License-Identifier: Apache-2.0
#include "osteon/render/skeleton_shape.h"

#include "osteon/render/palette.h"
#include "support/expect.h"

namespace osteon::render {
namespace {

TEST(SkeletonShape, encloses_the_joints_closely) {
  Skeleton s;
  const JointId root = s.add("root", std::nullopt, {0, 0, 0});
  const JointId tip = s.add("tip", root, {0, 2, 0});
  s.add("twin", tip, {0, 2, 0});  // a bone without length
  const auto shape = skeleton_shape(s, s.rest_positions, joint_colors(3), 0.1f);
  validate(shape.mesh);
  EXPECT_EQ(shape.colors.size(), shape.mesh.positions.size());
  const auto box = bounds(shape.mesh);  // bones are 1.3 times as thick as balls, the ball of a bone without length 0.35 times
  EXPECT_VEC3_NEAR(box.min(), Vec3f(-0.13f, -0.1f, -0.13f), 1e-3f);
  EXPECT_VEC3_NEAR(box.max(), Vec3f(0.13f, 2.035f, 0.13f), 1e-3f);
}

TEST(SkeletonShape, balls_along_short_bones_stay_apart) {
  Skeleton s;
  const JointId a = s.add("a", std::nullopt, {0, 0, 0});
  s.add("b", a, {0.1f, 0, 0});
  const auto box = bounds(skeleton_shape(s, s.rest_positions, joint_colors(2), 0.1f).mesh);
  EXPECT_LT(box.max().x(), 0.15f);
  EXPECT_GT(box.min().x(), -0.05f);
}

TEST(SkeletonShape, faces_outwards) {
  Skeleton s;
  const JointId a = s.add("a", std::nullopt, {0, 0, 0});
  s.add("b", a, {0.3f, 1, 0.2f});
  const auto shape = skeleton_shape(s, s.rest_positions, joint_colors(2), 0.05f);
  double volume = 0;  // of all parts together, by the divergence theorem
  for (const FaceId f : shape.mesh.faces.ids())
    volume += static_cast<double>(shape.mesh.positions[shape.mesh.faces[f][0]].dot(area_vector(shape.mesh, f))) / 6;
  const Components parts = connected_components(shape.mesh);
  EXPECT_EQ(parts.count, 3u);  // two balls and a bone
  EXPECT_GT(volume, 2 * 4.0 / 3 * 3.1 * 0.05 * 0.05 * 0.05);
}

}  // namespace
}  // namespace osteon::render
