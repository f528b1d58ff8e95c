// SPDX-License-Identifier: Apache-2.0
#include "osteon/render/lighting.h"

#include "osteon/mesh/shapes.h"
#include "support/expect.h"

namespace osteon::render {
namespace {

// A wall in the plane z = 0 of which the right half stands `step` nearer to the viewer.
DepthAndNormals wall(int size, float step) {
  const auto pixels = static_cast<std::size_t>(size * size);
  DepthAndNormals seen{size, size, std::vector<float>(pixels), std::vector<Vec3f>(pixels, Vec3f::UnitZ())};
  for (int y = 0; y < size; ++y)
    for (int x = size / 2; x < size; ++x) seen.depths[seen.index(x, y)] = step;
  return seen;
}

TEST(AmbientLight, a_flat_wall_is_fully_lit) {
  const LightMap light = ambient_light(wall(64, 0), {Eigen::Matrix3f::Identity(), Vec3f::Zero(), {32, 32}, 10}, 0.5f);
  for (const float value : light.values) EXPECT_EQ(value, 1.0f);
}

TEST(AmbientLight, the_foot_of_a_step_is_darker_than_its_top_and_than_the_wall) {
  const DepthAndNormals seen = wall(64, 0.5f);
  const LightMap light = ambient_light(seen, {Eigen::Matrix3f::Identity(), Vec3f::Zero(), {32, 32}, 10}, 0.5f);
  EXPECT_LT(light.values[seen.index(31, 32)], 0.9f);
  EXPECT_EQ(light.values[seen.index(32, 32)], 1.0f);
  EXPECT_EQ(light.values[seen.index(5, 32)], 1.0f);
}

TEST(ShadowMap, what_lies_behind_a_ball_is_dark_and_what_lies_before_it_is_lit) {
  const Vec3f to_light = Vec3f(1, 1, 0).normalized();
  const ShadowMap shadow(shapes::icosphere(3), to_light);
  EXPECT_EQ(shadow.light_at(-3 * to_light, 0.05f), 0.0f);
  EXPECT_EQ(shadow.light_at(3 * to_light, 0.05f), 1.0f);
  EXPECT_EQ(shadow.light_at({-3, 3, 0}, 0.05f), 1.0f);
  const float half = shadow.light_at(Vec3f(0, 0, 1) - 3 * to_light, 0.1f);  // on the rim of the shadow
  EXPECT_GT(half, 0.2f);
  EXPECT_LT(half, 0.8f);
}

TEST(ShadowMap, a_lit_ball_does_not_shade_itself) {
  const ShadowMap shadow(shapes::icosphere(4), Vec3f::UnitY());
  for (const Vec3f& p : {Vec3f(0, 1, 0), Vec3f(0.5f, 0.866f, 0), Vec3f(0, 0.6f, -0.8f)})
    EXPECT_EQ(shadow.light_at(1.004f * p, 0.01f), 1.0f);
}

TEST(GroundShadow, is_darkest_where_the_figure_touches_the_ground_and_gone_away_from_it) {
  const GroundShadow shadow(shapes::capsule(0.2f, 1));
  const float middle = shadow.darkness_at({0, 0, 0});
  EXPECT_GT(middle, 0.2f);
  EXPECT_LT(shadow.darkness_at({0.2f, 0, 0}), middle);
  EXPECT_EQ(shadow.darkness_at({3, 0, 0}), 0.0f);
  EXPECT_NEAR(shadow.darkness_at({0.1f, 0, 0}), shadow.darkness_at({-0.1f, 0, 0}), 0.02f);
}

}  // namespace
}  // namespace osteon::render
