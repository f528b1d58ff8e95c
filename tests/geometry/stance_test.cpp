// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/stance.h"

#include "osteon/mesh/shapes.h"
#include "support/expect.h"

namespace osteon::geometry {
namespace {

TriangleMesh turned(TriangleMesh mesh, const Eigen::Matrix3f& turn) {
  for (Vec3f& p : mesh.positions) p = turn * p;
  return mesh;
}

TEST(Stance, a_box_on_the_plane_z_stands_on_it_wherever_else_it_is) {
  const TriangleMesh on_z = shapes::shifted(shapes::box({1, 1, 2}), {5, 0, 1});
  EXPECT_EQ(stance(on_z), Stance::on_z);
  EXPECT_EQ(stance(shapes::shifted(on_z, {0, -3, 0})), Stance::on_z);
  EXPECT_EQ(stance(shapes::shifted(on_z, {0, 0, 4})), Stance::on_z);  // flies
}

TEST(Stance, turned_to_y_up_it_stands_on_y) {
  const TriangleMesh on_z = shapes::shifted(shapes::box({1, 1, 2}), {5, 0, 1});
  EXPECT_EQ(stance(turned(on_z, turn_z_up_to_y_up())), Stance::on_y);
}

TEST(Stance, around_the_origin_on_both_planes_or_sunk_into_one_it_is_unclear) {
  const TriangleMesh box = shapes::box({1, 1, 2});
  EXPECT_EQ(stance(box), Stance::unclear);
  EXPECT_EQ(stance(shapes::shifted(box, {0, 0.5f, 1})), Stance::unclear);
  EXPECT_EQ(stance(shapes::shifted(box, {0, 0.4f, 1})), Stance::unclear);      // sunk into y = 0 by a tenth, on z = 0
  EXPECT_EQ(stance(shapes::shifted(box, {0, -3.0f, 0.8f})), Stance::unclear);  // sunk into z = 0 by a tenth
}

TEST(Stance, vertices_of_no_face_say_nothing) {
  TriangleMesh mesh = shapes::shifted(shapes::box({1, 1, 2}), {0, 0, 1});
  mesh.positions.push_back({0, 0, -100});
  EXPECT_EQ(stance(mesh), Stance::on_z);
  EXPECT_EQ(stance(TriangleMesh{mesh.positions, {}}), Stance::unclear);
}

TEST(Stance, the_finer_side_is_that_with_more_faces_than_surface) {
  // Middle of the faces: 80 of 92 at (0.5, 0, 2); of the surface: the box's area is 6, the ball's nearly 4 pi / 100.
  const TriangleMesh mesh = shapes::merged(shapes::box({1, 1, 1}), shapes::shifted(shapes::icosphere(1, 0.1f), {0.5f, 3, 2}));
  const auto ball = static_cast<float>(surface_area(shapes::icosphere(1, 0.1f)));
  const float ahead = 80.0f / 92.0f - ball / (6.0f + ball), longest = bounds(mesh).sizes().maxCoeff();
  EXPECT_VEC3_NEAR(finer_side(mesh), Vec3f(0.5f, 0, 2) * ahead / longest, 1e-5f);
}

TEST(Stance, the_finer_side_turns_with_the_mesh) {
  const TriangleMesh mesh = shapes::merged(shapes::box({1, 1, 1}), shapes::shifted(shapes::icosphere(1, 0.1f), {0.5f, 3, 2}));
  const Eigen::Matrix3f turn = turn_to_front({1, 0, 0});
  EXPECT_VEC3_NEAR(finer_side(turned(mesh, turn)), turn * finer_side(mesh), 1e-6f);
}

TEST(Stance, an_even_shape_or_none_has_no_finer_side) {
  EXPECT_LT(finer_side(shapes::icosphere(2)).norm(), 1e-6f);
  EXPECT_EQ(finer_side(TriangleMesh{{Vec3f::Zero()}, {}}), Vec3f::Zero());
}

TEST(Stance, turns_to_the_front_are_exact_for_axes) {
  for (const Vec3f& axis : {Vec3f(1, 0, 0), Vec3f(-1, 0, 0), Vec3f(0, 0, 1), Vec3f(0, 0, -1)}) {
    EXPECT_EQ(turn_to_front(axis) * axis, Vec3f::UnitZ());
    EXPECT_EQ(turn_to_front(axis) * Vec3f::UnitY(), Vec3f::UnitY());
    EXPECT_EQ(turn_to_front(axis).determinant(), 1.0f);
  }
  const Vec3f slanting = Vec3f(0.3f, 0, -0.7f).normalized();
  EXPECT_VEC3_NEAR(turn_to_front(slanting) * slanting, Vec3f::UnitZ(), 1e-6f);
  EXPECT_EQ(turn_z_up_to_y_up() * Vec3f::UnitZ(), Vec3f::UnitY());
  EXPECT_EQ(turn_z_up_to_y_up().determinant(), 1.0f);
}

}  // namespace
}  // namespace osteon::geometry
