// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/symmetry.h"

#include <cmath>
#include <numbers>

#include "geometry/tube.h"
#include "osteon/base/random.h"
#include "osteon/mesh/shapes.h"
#include "support/expect.h"

namespace osteon::geometry {
namespace {

// A trunk with a head in front, arms raised forward and legs: symmetric about x = 0 and no other plane.
TriangleMesh doll() {
  TriangleMesh mesh = shapes::merged(shapes::capsule(0.12f, 0.4f), shapes::shifted(shapes::icosphere(2, 0.12f), {0, 0.6f, 0.05f}));
  for (float side : {1.0f, -1.0f}) {
    const Transform arm(Eigen::Translation3f(0.12f * side, 0.38f, 0) * Eigen::AngleAxisf(-1.2f * side, Vec3f::UnitZ()) *
                        Eigen::AngleAxisf(0.3f, Vec3f::UnitX()));
    const Transform leg(Eigen::Translation3f(0.07f * side, -0.5f, 0.02f));
    mesh = shapes::merged(shapes::merged(mesh, shapes::transformed(shapes::capsule(0.04f, 0.4f), arm)),
                          shapes::transformed(shapes::capsule(0.05f, 0.4f), leg));
  }
  return mesh;
}

Quatf random_turn(Random& random) { return Quatf(random.normal(), random.normal(), random.normal(), random.normal()).normalized(); }

float angle_between(const Vec3f& a, const Vec3f& b) {
  return std::acos(std::min(1.0f, std::abs(a.dot(b)))) * 180.0f / std::numbers::pi_v<float>;
}

TEST(Symmetry, of_an_upright_doll_is_exactly_x) {
  const auto plane = symmetry_plane(shapes::shifted(doll(), {0.3f, 1, 2}));
  ASSERT_TRUE(plane);
  EXPECT_EQ(plane->normal, Vec3f::UnitX());
  EXPECT_NEAR(plane->offset, 0.3f, 2e-3f);
}

TEST(Symmetry, is_found_in_any_position_and_size) {
  Random random(11);
  for (int i = 0; i < 20; ++i) {
    const Quatf turn = random_turn(random);
    const Vec3f shift(random.normal(), random.normal(), random.normal());
    const float scale = std::exp(random.normal());
    const auto plane = symmetry_plane(shapes::transformed(doll(), Transform(Eigen::Translation3f(shift) * turn * Eigen::Scaling(scale))));
    ASSERT_TRUE(plane);
    EXPECT_LT(angle_between(plane->normal, turn * Vec3f::UnitX()), 1.0f);
    EXPECT_LT(std::abs(plane->signed_distance(shift)), 0.01f * scale);
    EXPECT_GT(plane->normal.maxCoeff(), -plane->normal.minCoeff());
  }
}

TEST(Symmetry, of_a_shape_with_equal_principal_moments_is_found) {
  // A cube with a ball on one edge: the cube's moments are all equal, so the principal axes say little.
  const TriangleMesh mesh = shapes::merged(shapes::box({1, 1, 1}), shapes::shifted(shapes::icosphere(2, 0.2f), {0.5f, 0.25f, 0.5f}));
  Random random(4);
  for (int i = 0; i < 10; ++i) {
    const Quatf turn = random_turn(random);
    const auto plane = symmetry_plane(shapes::transformed(mesh, Transform(turn)));
    ASSERT_TRUE(plane);
    EXPECT_LT(angle_between(plane->normal, turn * Vec3f(1, 0, -1).normalized()), 1.0f);
  }
}

TEST(Symmetry, is_x_where_several_planes_are_equally_good) {
  for (const TriangleMesh& mesh : {shapes::icosphere(3), shapes::box({1, 2, 3}), shapes::capsule(0.2f, 1.0f)}) {
    const auto plane = symmetry_plane(mesh);
    ASSERT_TRUE(plane);
    EXPECT_EQ(plane->normal, Vec3f::UnitX());
    EXPECT_NEAR(plane->offset, 0.0f, 1e-3f);
  }
}

TEST(Symmetry, survives_a_small_one_sided_part) {
  const auto plane = symmetry_plane(shapes::merged(doll(), shapes::shifted(shapes::icosphere(1, 0.03f), {0.15f, 0.3f, 0.1f})));
  ASSERT_TRUE(plane);
  EXPECT_LT(angle_between(plane->normal, Vec3f::UnitX()), 1.0f);
}

TEST(Symmetry, of_a_helix_does_not_exist) {
  std::vector<Vec3f> spiral;  // flat: symmetric about its own plane
  TriangleMesh mesh;
  for (int i = 0; i <= 80; ++i) {
    const float t = static_cast<float>(i) / 80.0f * 3.0f * std::numbers::pi_v<float>;
    spiral.emplace_back(0.15f * t * std::cos(t), 0.15f * t * std::sin(t), 0.0f);
  }
  mesh = test::tube(spiral, 0.08f);
  EXPECT_TRUE(symmetry_plane(mesh));
  for (Vec3f& p : mesh.positions) p.z() += 0.8f * std::hypot(p.x(), p.y());  // pulled up into a cone
  EXPECT_FALSE(symmetry_plane(mesh));
}

TEST(Symmetry, of_a_mesh_without_area_does_not_exist) {
  TriangleMesh mesh;
  mesh.positions.push_back(Vec3f(1, 2, 3));
  EXPECT_FALSE(symmetry_plane(mesh));
}

}  // namespace
}  // namespace osteon::geometry
