// SPDX-License-Identifier: Apache-2.0
#include "osteon/render/palette.h"

#include "support/expect.h"

namespace osteon::render {
namespace {

TEST(Palette, oklch_without_chroma_is_grey_and_its_ends_are_black_and_white) {
  EXPECT_VEC3_NEAR(oklch(0, 0, 0.3f), Vec3f::Zero(), 1e-5f);
  EXPECT_VEC3_NEAR(oklch(1, 0, 0.3f), Vec3f::Ones(), 1e-4f);
  EXPECT_VEC3_NEAR(oklch(0.5f, 0, 0), Vec3f::Constant(0.125f), 1e-4f);  // lightness is the cube root of light
}

TEST(Palette, joints_that_follow_one_another_look_different) {
  const auto colors = joint_colors(60);
  for (std::size_t i = 1; i < colors.size(); ++i)
    EXPECT_GT((colors.raw()[i] - colors.raw()[i - 1]).norm(), 0.2f) << "joints " << i - 1 << " and " << i;
}

TEST(Palette, a_vertex_has_the_mean_of_its_joints_colours) {
  const PerJoint<Vec3f> colors{Vec3f(1, 0, 0), Vec3f(0, 1, 0)};
  SkinWeights weights;
  weights.append(std::vector<Influence>{{JointId{1}, 1}});
  weights.append(std::vector<Influence>{{JointId{0}, 0.75f}, {JointId{1}, 0.25f}});
  const auto vertices = weight_colors(weights, colors);
  EXPECT_VEC3_NEAR(vertices[VertexId{0}], Vec3f(0, 1, 0), 1e-6f);
  EXPECT_VEC3_NEAR(vertices[VertexId{1}], Vec3f(0.75f, 0.25f, 0), 1e-6f);
}

}  // namespace
}  // namespace osteon::render
