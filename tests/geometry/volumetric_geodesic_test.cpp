// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/volumetric_geodesic.h"

#include <algorithm>
#include <cmath>

#include "geometry/tube.h"
#include "osteon/base/parallel.h"
#include "osteon/geometry/body_graph.h"
#include "osteon/mesh/shapes.h"
#include "support/expect.h"

namespace osteon::geometry {
namespace {

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

TEST(StraightDistance, is_euclidean_whatever_lies_between) {
  const test::UTube u = test::u_tube(0.05f, 0.3f, 0.8f);
  const Matrix d = straight_distance(u.mesh, std::span(&u.left, 1));
  for (VertexId v : u.mesh.positions.ids()) EXPECT_NEAR(d(row(v), 0), euclidean(u.left, u.mesh.positions[v]), 1e-6f);
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

TEST(VolumetricGeodesic, passes_between_two_cylinders_that_touch_at_one_place_only) {
  const TriangleMesh limb = shapes::capsule(0.1f, 0.8f, 24, 12);
  const TriangleMesh both = shapes::merged(limb, shapes::shifted(limb, {0.2f, 0, 0}));
  const Segment bone{{0, 0, 0}, {0, 0.8f, 0}};
  const auto d = distances(both, bone);
  const auto all = both.positions.ids();
  const VertexId contact = *std::ranges::min_element(
      all, {}, [&](VertexId v) { return index(v) < limb.positions.size() ? 1.0f : d[row(v)]; });  // where the link arrives
  EXPECT_NEAR(d[row(contact)], 0.1f, 0.02f);
  for (VertexId v : both.positions.ids()) {
    const float straight = euclidean(bone, both.positions[v]);
    if (index(v) < limb.positions.size())
      EXPECT_NEAR(d[row(v)], straight, 1e-6f);
    else
      EXPECT_GE(d[row(v)], d[row(contact)] + 0.99f * (both.positions[v] - both.positions[contact]).norm());
  }
}

TEST(VolumetricGeodesic, passes_from_one_part_into_another_that_it_overlaps) {
  //  ___________________
  // (    body  (    )   )   the sleeve begins inside the body
  //  -----------(   )---
  const TriangleMesh body = shapes::capsule(0.15f, 0.6f, 24, 12);
  Transform turn(Eigen::AngleAxisf(-0.5f * std::numbers::pi_v<float>, Vec3f::UnitZ()));  // +y becomes +x
  const TriangleMesh sleeve = shapes::shifted(shapes::transformed(shapes::capsule(0.05f, 0.4f, 24, 12), turn), {0.05f, 0.3f, 0});
  const TriangleMesh both = shapes::merged(body, sleeve);
  const Segment spine{{0, 0, 0}, {0, 0.6f, 0}};
  const auto d = distances(both, spine);
  for (VertexId v : both.positions.ids())
    if (both.positions[v].x() > 0.48f) EXPECT_NEAR(d[row(v)], euclidean(spine, both.positions[v]), 1e-6f);  // through both
}

TEST(VolumetricGeodesic, of_a_piece_that_floats_leads_over_the_shortest_gap) {
  const TriangleMesh two = shapes::merged(shapes::icosphere(3, 0.1f), shapes::shifted(shapes::icosphere(3, 0.1f), {0.8f, 0, 0}));
  const auto d = distances(two, {{0, 0, 0}, {0, 0, 0}});
  for (VertexId v : two.positions.ids()) {
    const float x = two.positions[v].x();
    if (x < 0.4f)
      EXPECT_NEAR(d[row(v)], 0.1f, 1e-5f);
    else
      EXPECT_NEAR(d[row(v)], 0.7f + (two.positions[v] - Vec3f(0.7f, 0, 0)).norm(), 0.06f);  // the gap's ends are vertices, up to 0.02 off
  }
}

TEST(VolumetricGeodesic, of_a_bone_outside_enters_at_its_nearest_point) {
  const TriangleMesh ball = shapes::icosphere(4, 0.5f);
  const auto d = distances(ball, {{0, 0.7f, 0}, {0, 0.7f, 0}});
  for (VertexId v : ball.positions.ids()) {
    const float straight = (ball.positions[v] - Vec3f(0, 0.5f, 0)).norm();
    EXPECT_GE(d[row(v)], 0.19f + straight);
    EXPECT_LE(d[row(v)],
              0.25f + 1.25f * straight);  // by chords in seven directions; the nearest face's corners are up to an edge (0.04) away
  }
}

TEST(VolumetricGeodesic, of_a_bone_to_a_joint_astray_is_that_to_its_part_in_the_body) {
  const TriangleMesh limb = shapes::capsule(0.1f, 0.8f, 24, 12);
  const auto to_side = distances(limb, {{0, 0.4f, 0}, {0, 0.4f, 1}});
  for (const float far : {1e5f, 1e9f, 1e15f}) {
    const auto astray = distances(limb, {{0, 0.4f, 0}, {0, 0.4f, far}});
    EXPECT_LT((astray - to_side).cwiseAbs().maxCoeff(), 0.15f) << far;
  }
}

TEST(VolumetricGeodesic, reaches_both_sides_of_a_thin_wing_beside_the_bone) {
  const TriangleMesh wing = shapes::transformed(shapes::icosphere(4, 0.5f), Transform(Eigen::Scaling(1.0f, 0.004f, 0.6f)));
  const Segment bone{{-0.3f, 0.005f, 0}, {0.3f, 0.005f, 0}};  // just above the upper side
  const auto d = distances(wing, bone);
  for (VertexId v : wing.positions.ids()) EXPECT_LT(d[row(v)], euclidean(bone, wing.positions[v]) + 0.06f);
}

TEST(VolumetricGeodesic, never_falls_below_euclidean_and_changes_at_most_by_the_length_of_a_way) {
  const test::UTube u = test::u_tube(0.08f, 0.1f, 0.6f);
  const Segment bone{{0.1f, -0.2f, 0.02f}, {-0.3f, 0.5f, 0}};  // leaves and enters the tube
  const auto d = distances(u.mesh, bone);
  const VoxelGrid grid = voxelize(u.mesh);
  const SurfaceGraph graph = body_graph(u.mesh, BodyLines(u.mesh, grid), 0.02f);
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
