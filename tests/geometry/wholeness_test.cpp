// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/wholeness.h"

#include <algorithm>
#include <numbers>

#include "osteon/geometry/cleanup.h"
#include "osteon/mesh/shapes.h"
#include "support/expect.h"

namespace osteon::geometry {
namespace {

using shapes::merged;
using shapes::shifted;

// The faces on one side of x = 0; a cut along edges.
TriangleMesh half_of(const TriangleMesh& mesh) {
  TriangleMesh half = mesh;
  half.faces.raw().clear();
  for (const Triangle& face : mesh.faces)
    if (std::ranges::all_of(face, [&](VertexId v) { return mesh.positions[v].x() >= -1e-6f; })) half.faces.push_back(face);
  return clean(half).mesh;
}

TEST(Wholeness, half_a_body_is_open_at_a_side_whichever_it_is) {
  const TriangleMesh body = shapes::capsule(0.5f, 1.0f), half = half_of(body);
  EXPECT_FALSE(is_open_at_a_side(body, 1));
  for (const float angle : {0.0f, 0.5f, 1.0f, 1.5f}) {
    const Transform turn(Eigen::AngleAxisf(angle * std::numbers::pi_v<float>, Vec3f::UnitY()));
    EXPECT_TRUE(is_open_at_a_side(shapes::transformed(half, turn), 1));
  }
}

TEST(Wholeness, what_is_open_below_or_a_sheet_is_no_half) {
  const Transform down(Eigen::AngleAxisf(0.5f * std::numbers::pi_v<float>, Vec3f::UnitZ()));
  EXPECT_FALSE(is_open_at_a_side(shapes::transformed(half_of(shapes::icosphere(3)), down), 1));
  EXPECT_FALSE(is_open_at_a_side(shapes::sheet(4, 4), 1));
}

TEST(Wholeness, two_bodies_with_air_between_them_stand_side_by_side) {
  const TriangleMesh body = shapes::capsule(0.5f, 1.0f);
  EXPECT_FALSE(stands_side_by_side(body, 1));
  EXPECT_TRUE(stands_side_by_side(merged(body, shifted(body, {1.1f, 0, 0})), 1));
  EXPECT_TRUE(stands_side_by_side(merged(shifted(body, {0, 0.3f, -3}), body), 1));
  EXPECT_FALSE(stands_side_by_side(merged(body, shifted(body, {0.9f, 0, 0})), 1));
  EXPECT_FALSE(stands_side_by_side(merged(body, shifted(body, {0, 3, 0})), 1)) << "a head that floats";
}

TEST(Wholeness, hands_that_float_beside_a_body_and_a_cape_behind_it_are_part_of_it) {
  TriangleMesh mesh = merged(shapes::capsule(0.5f, 1.0f), shifted(shapes::sheet(4, 4), {-0.5f, 0, -0.6f}));
  for (const float side : {-1.0f, 1.0f}) mesh = merged(mesh, shifted(shapes::icosphere(2, 0.2f), {side, 0, 0}));
  EXPECT_FALSE(stands_side_by_side(mesh, 1));
}

}  // namespace
}  // namespace osteon::geometry
