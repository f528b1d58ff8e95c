// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/volumetric_geodesic.h"

#include <algorithm>
#include <cmath>

#include "geometry/tube.h"
#include "osteon/base/parallel.h"
#include "osteon/geometry/surface_graph.h"
#include "osteon/mesh/shapes.h"
#include "support/expect.h"

namespace osteon::geometry {
namespace {

TriangleMesh shifted(TriangleMesh mesh, const Vec3f& by) {
  return shapes::transformed(std::move(mesh), Transform(Eigen::Translation3f(by)));
}

float euclidean(const Segment& s, const Vec3f& p) {
  const Vec3f d = s.b - s.a;
  const float t = d.squaredNorm() > 0.0f ? std::clamp((p - s.a).dot(d) / d.squaredNorm(), 0.0f, 1.0f) : 0.0f;
  return (s.a + t * d - p).norm();
}

// (V) distances to one bone.
Eigen::VectorXf distances(const TriangleMesh& mesh, const Segment& bone) {
  return volumetric_geodesic_distance(mesh, voxelize(mesh), std::span(&bone, 1)).col(0);
}

Eigen::Index row(VertexId v) { return static_cast<Eigen::Index>(index(v)); }

TEST(VolumetricGeodesic, is_euclidean_where_the_bone_is_seen) {
  const TriangleMesh limb = shapes::capsule(0.1f, 0.8f, 24, 12);
  for (const Segment& bone : {Segment{{0, 0, 0}, {0, 0.8f, 0}}, Segment{{0.03f, 0.2f, 0}, {0.03f, 0.2f, 0}}}) {
    const auto d = distances(limb, bone);
    for (VertexId v : limb.positions.ids()) EXPECT_NEAR(d[row(v)], euclidean(bone, limb.positions[v]), 1e-6f);
  }
}

TEST(VolumetricGeodesic, goes_around_the_bend_of_a_u) {
  const test::UTube u = test::u_tube(0.05f, 0.3f, 0.8f);
  const Vec3f right_tip(0.5f * u.spread, 0.8f, 0);
  const Segment left_tip{u.left.a, u.left.a};
  const auto d = distances(u.mesh, left_tip);
  for (VertexId v : u.mesh.positions.ids())
    if ((u.mesh.positions[v] - right_tip).norm() < 0.06f) {
      EXPECT_GT(d[row(v)], 0.9f * u.center_line);  // a way through the inside of the bend is shorter than its middle
      EXPECT_LT(d[row(v)], 1.1f * u.center_line);
    }
}

TEST(VolumetricGeodesic, does_not_leak_through_a_gap_thinner_than_a_voxel) {
  const test::UTube u = test::u_tube(0.05f, 0.002f, 0.9f);
  const auto d = distances(u.mesh, {u.left.a, {u.left.a.x(), 0.6f, 0}});
  for (VertexId v : u.mesh.positions.ids())
    if (const Vec3f& p = u.mesh.positions[v]; p.x() > 0 && p.y() > 0)
      EXPECT_GT(d[row(v)], 0.55f + p.y());  // down to 0 and up again, less 0.05
}

TEST(VolumetricGeodesic, does_not_leak_between_two_cylinders_that_touch) {
  const TriangleMesh limb = shapes::capsule(0.1f, 0.8f, 24, 12);
  const TriangleMesh both = shapes::merged(limb, shifted(limb, {0.2f, 0, 0}));
  const Segment bone{{0, 0, 0}, {0, 0.8f, 0}};
  const auto d = distances(both, bone);
  for (VertexId v : both.positions.ids()) {
    const float straight = euclidean(bone, both.positions[v]);
    if (index(v) < limb.positions.size())
      EXPECT_NEAR(d[row(v)], straight, 1e-6f);
    else
      EXPECT_NEAR(d[row(v)], 1.0f + straight, 1e-6f);
  }
}

TEST(VolumetricGeodesic, passes_from_one_part_into_another_that_it_overlaps) {
  //  ___________________
  // (    body  (    )   )   the sleeve begins inside the body
  //  -----------(   )---
  const TriangleMesh body = shapes::capsule(0.15f, 0.6f, 24, 12);
  Transform turn(Eigen::AngleAxisf(-0.5f * std::numbers::pi_v<float>, Vec3f::UnitZ()));  // +y becomes +x
  const TriangleMesh sleeve = shifted(shapes::transformed(shapes::capsule(0.05f, 0.4f, 24, 12), turn), {0.05f, 0.3f, 0});
  const TriangleMesh both = shapes::merged(body, sleeve);
  const Segment spine{{0, 0, 0}, {0, 0.6f, 0}};
  const auto d = distances(both, spine);
  for (VertexId v : both.positions.ids())
    if (both.positions[v].x() > 0.48f) EXPECT_NEAR(d[row(v)], euclidean(spine, both.positions[v]), 1e-6f);  // through both
}

TEST(VolumetricGeodesic, prefers_every_bone_within_reach_to_those_out_of_reach) {
  const TriangleMesh two = shapes::merged(shapes::icosphere(3, 0.1f), shifted(shapes::icosphere(3, 0.1f), {0.8f, 0, 0}));
  const std::vector<Segment> bones{{{0, 0, 0}, {0, 0, 0}}, {{0.8f, 0, 0}, {0.8f, 0, 0}}};
  const Matrix d = volumetric_geodesic_distance(two, voxelize(two), bones);
  for (VertexId v : two.positions.ids()) {
    const Eigen::Index own = two.positions[v].x() > 0.4f, other = 1 - own;
    EXPECT_NEAR(d(row(v), own), 0.1f, 1e-5f);
    EXPECT_NEAR(d(row(v), other), 1.0f + euclidean(bones[static_cast<std::size_t>(other)], two.positions[v]), 1e-5f);
  }
}

TEST(VolumetricGeodesic, of_a_bone_outside_runs_over_the_surface_from_its_nearest_point) {
  const TriangleMesh ball = shapes::icosphere(4, 0.5f);
  const auto d = distances(ball, {{0, 0.7f, 0}, {0, 0.7f, 0}});
  for (VertexId v : ball.positions.ids()) {
    const float arc = 0.5f * std::acos(std::clamp(ball.positions[v].y() / 0.5f, -1.0f, 1.0f));
    EXPECT_NEAR(d[row(v)], 0.2f + arc, 0.06f * arc + 0.05f);  // the nearest face's corners are up to an edge (0.04) away
  }
}

TEST(VolumetricGeodesic, never_falls_below_euclidean_and_changes_at_most_by_the_length_of_a_way) {
  const test::UTube u = test::u_tube(0.08f, 0.1f, 0.6f);
  const Segment bone{{0.1f, -0.2f, 0.02f}, {-0.3f, 0.5f, 0}};  // leaves and enters the tube
  const auto d = distances(u.mesh, bone);
  const SurfaceGraph graph = surface_graph(u.mesh, 0.02f);
  for (VertexId v : u.mesh.positions.ids()) {
    EXPECT_GE(d[row(v)], euclidean(bone, u.mesh.positions[v]) - 1e-6f);
    for (const auto& [to, length] : graph.of(index(v))) EXPECT_LE(d[row(v)], d[to] + length + 1e-6f);
  }
}

TEST(VolumetricGeodesic, does_not_depend_on_the_number_of_threads) {
  const test::UTube u = test::u_tube(0.08f, 0.1f, 0.6f);
  const VoxelGrid grid = voxelize(u.mesh);
  const std::vector<Segment> bones{u.left, {{0, -0.1f, 0}, {0, -0.1f, 0}}, {{0.1f, 0, 0}, {0.1f, 0.5f, 0}}};
  const int before = threads();
  set_threads(1);
  const Matrix one = volumetric_geodesic_distance(u.mesh, grid, bones);
  set_threads(3);
  const Matrix three = volumetric_geodesic_distance(u.mesh, grid, bones);
  set_threads(before);
  EXPECT_EQ(one, three);
}

}  // namespace
}  // namespace osteon::geometry
