// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/mirror_pairs.h"

#include "osteon/base/random.h"
#include "osteon/geometry/working_mesh.h"
#include "osteon/mesh/shapes.h"
#include "support/expect.h"

namespace osteon::geometry {
namespace {

// Something lopsided and its mirror image across x = 0, in the frame of the networks.
TriangleMesh doubled() {
  const Transform place = Eigen::Translation3f(0.3f, 0.2f, 0) * Transform(Eigen::AngleAxisf(0.4f, Vec3f(1, 2, 3).normalized()));
  const TriangleMesh half = shapes::transformed(shapes::capsule(0.1f, 0.5f), place);
  TriangleMesh mesh = shapes::merged(half, shapes::transformed(half, Transform(Eigen::Scaling(-1.0f, 1.0f, 1.0f))));
  const Normalization frame = normalization_of(mesh);
  for (Vec3f& p : mesh.positions) p = frame.apply(p);
  return mesh;
}

void expect_images(const TriangleMesh& mesh, const MirrorPairs& pairs, float tolerance) {
  for (VertexId v : mesh.positions.ids()) {
    EXPECT_VEC3_NEAR(mesh.positions[pairs.partner[v]], pairs.plane.mirror(mesh.positions[v]), tolerance);
    EXPECT_EQ(pairs.partner[pairs.partner[v]], v);
  }
}

TEST(MirrorPairs, of_a_mirrored_mesh_are_exact) {
  const TriangleMesh mesh = doubled();
  const auto pairs = mirror_pairs(mesh, {Vec3f(1, 0.002f, -0.001f).normalized(), 0.001f});
  ASSERT_TRUE(pairs);
  EXPECT_EQ(pairs->plane.normal, Vec3f::UnitX());
  EXPECT_EQ(pairs->plane.offset, 0.0f);
  expect_images(mesh, *pairs, 0.0f);
}

TEST(MirrorPairs, are_found_in_any_position_from_a_plane_that_is_nearly_right) {
  Random random(3);
  for (int i = 0; i < 10; ++i) {
    const Quatf turn = Quatf(random.normal(), random.normal(), random.normal(), random.normal()).normalized();
    const TriangleMesh mesh = shapes::transformed(doubled(), Transform(Eigen::Translation3f(0.1f, 0.2f, -0.3f) * turn));
    const Vec3f normal = turn * Vec3f::UnitX();
    const Plane near{(normal + turn * Vec3f(0, 0.002f, -0.002f)).normalized(), normal.dot(Vec3f(0.1f, 0.2f, -0.3f)) + 0.001f};
    const auto pairs = mirror_pairs(mesh, near);
    ASSERT_TRUE(pairs);
    EXPECT_VEC3_NEAR(pairs->plane.normal, normal, 1e-5f);
    expect_images(mesh, *pairs, 1e-5f);
  }
}

TEST(MirrorPairs, are_none_where_one_vertex_has_no_partner) {
  TriangleMesh mesh = doubled();
  mesh.positions[VertexId{7}] += Vec3f(0, 0, 1e-3f);
  EXPECT_FALSE(mirror_pairs(mesh, {Vec3f::UnitX(), 0.0f}));
  EXPECT_FALSE(mirror_pairs(shapes::capsule(0.1f, 0.8f), {Vec3f(1, 1, 0).normalized(), 0.3f}));
}

TEST(MirrorPairs, stay_in_their_part_where_parts_touch) {
  const TriangleMesh low = shapes::box({0.4f, 0.5f, 0.3f});
  const TriangleMesh mesh = shapes::merged(low, shapes::transformed(low, Transform(Eigen::Translation3f(0, 0.5f, 0))));
  const auto pairs = mirror_pairs(mesh, {Vec3f::UnitX(), 0.0f});
  ASSERT_TRUE(pairs);
  const Components parts = connected_components(mesh);
  for (VertexId v : mesh.positions.ids()) EXPECT_EQ(parts.of[v], parts.of[pairs->partner[v]]);
}

TEST(MirrorPairs, are_not_looked_for_where_all_lies_in_a_few_cells_beside_something_far_away) {
  TriangleMesh mesh = shapes::icosphere(5, 1e-4f);
  mesh.positions[VertexId{0}] = {0, 1, 0};
  for (int k = 0; k < 2; ++k) mesh = shapes::merged(mesh, mesh);  // 40 thousand vertices
  EXPECT_EQ(mirror_pairs(mesh, {Vec3f::UnitX(), 0.0f}), std::nullopt);
}

}  // namespace
}  // namespace osteon::geometry
