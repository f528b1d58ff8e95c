// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/joint_rays.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "osteon/mesh/shapes.h"
#include "support/expect.h"

namespace osteon::geometry {
namespace {

// A limb along y with the axis from (0,0,0) to (0,0.8,0); fine enough for vertices everywhere near a hit.
TriangleMesh limb(float radius) { return shapes::capsule(radius, 0.8f, 64, 32); }

TEST(PerpendicularHits, of_a_round_limb_form_a_regular_polygon) {
  const TriangleMesh mesh = limb(0.1f);
  const SurfaceHits hits = perpendicular_hits(mesh, Bvh(mesh), {0, 0.4f, 0}, Vec3f::UnitY());
  ASSERT_EQ(hits.points.size(), 14u);
  for (std::size_t k = 0; k < 14; ++k) {
    EXPECT_NEAR(hits.distances[k], 0.1f, 2e-4f);
    EXPECT_NEAR(hits.points[k].y(), 0.4f, 1e-6f);
    const float cosine = hits.points[k].normalized().dot(Vec3f(0, 0.4f, 0).normalized());
    EXPECT_NEAR(cosine, 0.4f / std::hypot(0.4f, 0.1f), 1e-3f);
    const float side = (hits.points[k] - hits.points[(k + 1) % 14]).norm();
    EXPECT_NEAR(side, 2 * 0.1f * std::sin(std::numbers::pi_v<float> / 14), 3e-4f);
  }
}

TEST(PerpendicularHits, fall_back_to_the_nearest_face_when_no_ray_meets_the_surface) {
  const TriangleMesh mesh = shapes::box({1, 1, 1});
  const SurfaceHits hits = perpendicular_hits(mesh, Bvh(mesh), {0.1f, 2, 0.2f}, Vec3f::UnitY());  // a horizontal plane above the box
  ASSERT_EQ(hits.points.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_FLOAT_EQ(hits.points[k].y(), 0.5f);
    EXPECT_FLOAT_EQ(hits.distances[k], (hits.points[k] - Vec3f(0.1f, 2, 0.2f)).norm());
  }
}

TEST(JointTolerances, are_the_radius_on_the_axis_of_a_limb) {
  const std::vector<Vec3f> joints{{0, 0.1f, 0}, {0, 0.4f, 0}, {0, 0.7f, 0}};
  const std::vector<int> parents{-1, 0, 1};
  for (float tolerance : joint_tolerances(limb(0.1f), joints, parents)) EXPECT_NEAR(tolerance, 0.1f, 2e-4f);
}

TEST(JointTolerances, average_over_the_bones_that_meet) {
  // A joint with one bone along x and one along y in a box: rays of the first see the y-z section, of the second the x-z section.
  const TriangleMesh mesh = shapes::box({2, 1, 1});
  const std::vector<Vec3f> joints{{0, 0, 0}, {0.5f, 0, 0}, {0, 0.3f, 0}};
  const float both = joint_tolerances(mesh, joints, std::vector<int>{-1, 0, 0})[0];
  const float along_x = joint_tolerances(mesh, std::span(joints).first(2), std::vector<int>{-1, 0})[0];
  const std::vector<Vec3f> upwards{joints[0], joints[2]};
  const float along_y = joint_tolerances(mesh, upwards, std::vector<int>{-1, 0})[0];
  EXPECT_NEAR(both, 0.5f * (along_x + along_y), 1e-6f);
  EXPECT_LT(along_x, along_y);
}

TEST(JointTolerances, of_a_lone_joint_are_horizontal) {
  const std::vector<Vec3f> joints{{0, 0.4f, 0}};
  EXPECT_NEAR(joint_tolerances(limb(0.1f), joints, std::vector<int>{-1})[0], 0.1f, 2e-4f);
}

TEST(AttentionLabels, mark_the_rings_around_the_joints_and_nothing_else) {
  const TriangleMesh mesh = shapes::transformed(shapes::icosphere(5, 0.5f), Transform(Eigen::Scaling(0.3f, 1.0f, 0.3f)));
  const std::vector<Vec3f> joints{{0, -0.3f, 0}, {0, 0.2f, 0}};
  const auto labels = attention_labels(mesh, joints, std::vector<int>{-1, 0});
  int marked = 0;
  for (VertexId v : mesh.positions.ids()) {
    const float y = mesh.positions[v].y(), off = std::min(std::abs(y + 0.3f), std::abs(y - 0.2f));
    if (labels[index(v)]) EXPECT_LE(off, 0.02f);
    marked += labels[index(v)];
  }
  EXPECT_GT(marked, 100);
}

TEST(AttentionLabels, leave_out_hits_on_a_part_far_away) {
  // A finger beside a wall: the rays that pass the open side of the finger would mark the wall.
  TriangleMesh finger = shapes::capsule(0.02f, 0.2f, 24, 12);
  PerFace<Triangle> half;
  for (const auto& t : finger.faces)
    if (finger.positions[t[0]].x() < 0.012f) half.push_back(t);
  finger.faces = half;
  const Transform upright(Eigen::Translation3f(0.3f, -0.5f, 0) * Eigen::AngleAxisf(0.5f * std::numbers::pi_v<float>, -Vec3f::UnitY()));
  const TriangleMesh mesh = shapes::merged(finger, shapes::transformed(shapes::sheet(60, 60), upright));
  const auto labels = attention_labels(mesh, std::vector<Vec3f>{{0, 0.05f, 0}, {0, 0.15f, 0}}, std::vector<int>{-1, 0});
  for (std::size_t v = finger.positions.size(); v < labels.size(); ++v) EXPECT_EQ(labels[v], 0);
  EXPECT_GT(std::ranges::count(labels, 1), 0);
}

TEST(AttentionLabels, mark_at_least_six_vertices_of_every_joint) {
  const TriangleMesh mesh = shapes::icosphere(1, 0.5f);  // 42 vertices, far apart
  const auto labels = attention_labels(mesh, std::vector<Vec3f>{{0, 0, 0}, {0, 0.45f, 0}}, std::vector<int>{-1, 0});
  EXPECT_GE(std::ranges::count(labels, 1), 6);
  VertexId top{0};
  for (VertexId v : mesh.positions.ids())
    if (mesh.positions[v].y() > mesh.positions[top].y()) top = v;
  EXPECT_EQ(labels[index(top)], 1);
}

}  // namespace
}  // namespace osteon::geometry
