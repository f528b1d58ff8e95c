// SPDX-License-Identifier: Apache-2.0
#include "osteon/render/camera.h"

#include <numbers>

#include "osteon/mesh/shapes.h"
#include "support/expect.h"

namespace osteon::render {
namespace {

constexpr float quarter_turn = std::numbers::pi_v<float> / 2;

TEST(Camera, the_front_view_sees_world_axes) { EXPECT_TRUE(view_axes({}).isApprox(Eigen::Matrix3f::Identity())); }

TEST(Camera, a_character_seen_from_its_right_faces_right_in_the_picture) {
  const Eigen::Matrix3f axes = view_axes({-quarter_turn, 0});
  EXPECT_VEC3_NEAR(axes * Vec3f::UnitZ(), Vec3f::UnitX(), 1e-6f);   // its front
  EXPECT_VEC3_NEAR(axes * -Vec3f::UnitX(), Vec3f::UnitZ(), 1e-6f);  // its right side looks at the viewer
}

TEST(Camera, axes_are_a_rotation_in_every_view) {
  for (const float yaw : {-2.0f, 0.3f, 3.0f})
    for (const float pitch : {-quarter_turn, -0.4f, 0.0f, 1.0f, quarter_turn}) {
      const Eigen::Matrix3f axes = view_axes({yaw, pitch});
      EXPECT_TRUE((axes * axes.transpose()).isApprox(Eigen::Matrix3f::Identity(), 1e-5f));
      EXPECT_NEAR(axes.determinant(), 1, 1e-5f);
    }
}

TEST(Camera, up_in_the_world_is_up_in_the_picture_and_the_target_is_at_the_centre) {
  const Camera camera{view_axes({}), {1, 2, 3}, {100, 50}, 10};
  EXPECT_VEC3_NEAR(camera.project({1, 2, 3}), Vec3f(100, 50, 0), 1e-5f);
  EXPECT_VEC3_NEAR(camera.project({2, 3, 7}), Vec3f(110, 40, 4), 1e-5f);
}

TEST(Camera, seen_bounds_of_a_sphere_are_the_same_from_everywhere) {
  const TriangleMesh sphere = shapes::icosphere(4, 2.0f);
  for (const View& view : {View{}, View{1, 0.5f}, View{-2, 1}})
    EXPECT_VEC3_NEAR(seen_bounds(sphere.positions, view).sizes(), Vec3f(4, 4, 4), 0.03f);
}

}  // namespace
}  // namespace osteon::render
