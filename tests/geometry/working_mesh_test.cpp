// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/working_mesh.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>

#include "geometry/mesh_makers.h"
#include "osteon/base/parallel.h"
#include "osteon/geometry/subdivide.h"
#include "osteon/mesh/shapes.h"
#include "support/expect.h"

namespace osteon::geometry {
namespace {

using testing::HasSubstr;

Vec3f position_of(const SurfacePoint& point, const WorkingMesh& working) {
  Vec3f p = Vec3f::Zero();
  for (std::size_t k = 0; k < 3; ++k) p += point.weights[k] * working.mesh.positions[point.vertices[k]];
  return p;
}

void expect_same_bytes(const TriangleMesh& a, const TriangleMesh& b) {
  ASSERT_EQ(a.positions.size(), b.positions.size());
  EXPECT_EQ(std::memcmp(a.positions.data(), b.positions.data(), a.positions.size() * sizeof(Vec3f)), 0);
  EXPECT_EQ(a.faces, b.faces);
}

TEST(Normalization, puts_the_longest_side_to_one_and_the_feet_to_zero) {
  const TriangleMesh box = shapes::shifted(shapes::box({1, 4, 2}), {7, 5, -3});
  const Normalization n = normalization_of(box);
  EXPECT_VEC3_NEAR(n.apply({7, 3, -3}), Vec3f(0, 0, 0), 1e-6f);
  EXPECT_VEC3_NEAR(n.apply({7.5f, 7, -2}), Vec3f(0.125f, 1, 0.25f), 1e-6f);
  EXPECT_VEC3_NEAR(n.undo(n.apply({1, 2, 3})), Vec3f(1, 2, 3), 1e-5f);
}

TEST(WorkingMesh, has_about_as_many_vertices_as_wanted) {
  EXPECT_EQ(make_working_mesh(shapes::icosphere(6)).mesh.positions.size(), 1200u);
  EXPECT_EQ(make_working_mesh(shapes::icosphere(6), {.target_vertices = 3000}).mesh.positions.size(), 3000u);
  EXPECT_GE(make_working_mesh(shapes::box({1, 1, 1})).mesh.positions.size(), 1000u);
  for (const auto& [name, mesh] : test::awkward_meshes()) {
    SCOPED_TRACE(name);
    const WorkingMesh working = make_working_mesh(mesh);
    validate(working.mesh);
    EXPECT_GE(working.mesh.positions.size(), 1000u);
    EXPECT_LE(working.mesh.positions.size(), 1400u);
    EXPECT_NEAR(bounds(working.mesh).sizes().maxCoeff(), 1, 0.01f);
  }
}

TEST(WorkingMesh, of_a_body_inside_out_is_that_of_the_body) {
  const TriangleMesh body = shapes::icosphere(5);
  const WorkingMesh working = make_working_mesh(test::flipped(body));
  expect_same_bytes(working.mesh, make_working_mesh(body).mesh);
  EXPECT_THAT(working.clean.repairs, testing::ElementsAre(HasSubstr("inside out")));
}

TEST(WorkingMesh, does_not_depend_on_the_order_of_vertices_and_faces_nor_on_threads) {
  auto meshes = test::awkward_meshes();
  meshes.emplace_back("large sphere", shapes::icosphere(5));
  meshes.emplace_back("large sphere of separate faces", test::unshared(shapes::icosphere(5)));
  const int before = threads();
  for (const auto& [name, mesh] : meshes) {
    SCOPED_TRACE(name);
    const WorkingMesh working = make_working_mesh(mesh);
    for (std::uint64_t seed : {4, 5}) {
      set_threads(static_cast<int>(seed - 3));
      expect_same_bytes(working.mesh, make_working_mesh(test::shuffled(mesh, seed)).mesh);
    }
    set_threads(before);
  }
}

TEST(WorkingMesh, long_triangles_get_vertices_beside_a_fine_part) {
  const TriangleMesh mesh = shapes::merged(shapes::shifted(shapes::icosphere(5, 0.1f), {0, 1.1f, 0}), shapes::box({0.5f, 2, 0.5f}));
  const WorkingMesh working = make_working_mesh(mesh);
  std::size_t in_box = 0;
  for (const Vec3f& p : working.mesh.positions) in_box += working.normalization.undo(p).y() < 0.99f;
  EXPECT_GT(in_box, 300u);
}

TEST(WorkingMesh, of_thousands_of_pieces_the_largest_stay) {
  TriangleMesh mesh = shapes::icosphere(4);
  Random random(1);
  for (int i = 0; i < 3000; ++i) {
    const Vec3f at(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    const VertexId a = mesh.positions.push_back(at), b = mesh.positions.push_back(at + Vec3f(0.01f, 0, 0));
    mesh.faces.push_back({a, b, mesh.positions.push_back(at + Vec3f(0, 0.01f, 0))});
  }
  const WorkingMesh working = make_working_mesh(mesh);
  EXPECT_LE(working.mesh.positions.size(), 5000u);
  std::size_t on_sphere = 0;
  for (const Vec3f& p : working.mesh.positions) on_sphere += working.normalization.undo(p).norm() > 0.97f;
  EXPECT_GT(on_sphere, 200u);
  EXPECT_EQ(carry_back(working).size(), mesh.positions.size());
}

TEST(WorkingMesh, refuses_meshes_without_area) {
  TriangleMesh line;
  line.positions = {Vec3f(0, 0, 0), Vec3f(1, 0, 0), Vec3f(2, 0, 0)};
  EXPECT_THAT(test::error_of([&] { make_working_mesh(line); }), HasSubstr("0 faces, but none with area"));
  line.faces = {{VertexId{0}, VertexId{1}, VertexId{2}}, {VertexId{0}, VertexId{0}, VertexId{1}}};
  EXPECT_THAT(test::error_of([&] { make_working_mesh(line); }), HasSubstr("2 faces, but none with area"));
  line.positions = PerVertex<Vec3f>(3, Vec3f(1, 1, 1));
  EXPECT_THAT(test::error_of([&] { make_working_mesh(line); }), HasSubstr("none with area"));
  EXPECT_THAT(test::error_of([&] { normalization_of(line); }), HasSubstr("0 in size"));
}

TEST(CarryBack, of_a_mesh_that_was_not_reduced_is_the_identity) {
  const TriangleMesh sphere = test::shuffled(subdivide(shapes::icosphere(3), {.most_vertices = 1100}), 1);
  const WorkingMesh working = make_working_mesh(sphere);
  const auto points = carry_back(working);
  for (VertexId v : sphere.positions.ids()) {
    const auto& w = points[v].weights;
    ASSERT_EQ(*std::max_element(w.begin(), w.end()), 1.0f);
    EXPECT_EQ(position_of(points[v], working), working.normalization.apply(sphere.positions[v]));
  }
}

TEST(CarryBack, keeps_the_vertices_of_a_subdivided_mesh) {
  const TriangleMesh box = shapes::box({1, 2, 3});
  const WorkingMesh working = make_working_mesh(box);
  const auto points = carry_back(working);
  for (VertexId v : box.positions.ids()) EXPECT_EQ(position_of(points[v], working), working.normalization.apply(box.positions[v]));
}

TEST(CarryBack, weights_are_convex_and_points_are_near) {
  for (const TriangleMesh& mesh : {shapes::icosphere(6), test::unshared(shapes::icosphere(5)), test::moebius_strip(1000)}) {
    const WorkingMesh working = make_working_mesh(mesh);
    const auto points = carry_back(working);
    ASSERT_EQ(points.size(), mesh.positions.size());
    for (VertexId v : mesh.positions.ids()) {
      const auto& w = points[v].weights;
      EXPECT_NEAR(w[0] + w[1] + w[2], 1, 1e-6f);
      EXPECT_GE(std::min({w[0], w[1], w[2]}), 0.0f);
      EXPECT_VEC3_NEAR(position_of(points[v], working), working.normalization.apply(mesh.positions[v]), 0.004f);
    }
  }
}

TEST(CarryBack, parts_that_touch_do_not_mix) {
  const TriangleMesh part = shapes::icosphere(4);
  for (float gap : {0.0f, 1e-4f, -0.02f}) {  // touching, nearly touching, overlapping
    const TriangleMesh both = shapes::merged(part, shapes::shifted(part, {0, 2 + gap, 0}));
    const WorkingMesh working = make_working_mesh(both);
    const Components parts = connected_components(working.mesh);
    ASSERT_EQ(parts.count, 2u);
    const auto points = carry_back(working);
    const std::uint32_t lower = parts.of[points[VertexId{0}].vertices[0]];
    for (VertexId v : both.positions.ids()) {
      const bool is_lower = index(v) < part.positions.size();
      for (VertexId w : points[v].vertices) EXPECT_EQ(parts.of[w] == lower, is_lower);
    }
  }
}

TEST(CarryBack, does_not_jump_across_a_thin_gap) {
  // A hairpin: two long arms side by side, joined at the bottom, 0.01 apart.
  TriangleMesh pin = shapes::sheet(200, 20);
  for (Vec3f& p : pin.positions) {
    const float along = p.x() * 4 - 2;
    p = Vec3f(along < 0 ? -0.005f : 0.005f, std::abs(along), 0.2f * p.y());
  }
  const WorkingMesh working = make_working_mesh(pin);
  const auto points = carry_back(working);
  for (VertexId v : pin.positions.ids()) {
    if (pin.positions[v].y() < 0.2f) continue;  // the bend
    const Vec3f found = working.normalization.undo(position_of(points[v], working));
    EXPECT_EQ(found.x() < 0, pin.positions[v].x() < 0);
  }
}

// Around the hub of a fan nobody walks, yet all its vertices find where they are.
TEST(CarryBack, of_a_fan_each_vertex_gets_a_point_near_it) {
  constexpr std::uint32_t kSpokes = 700;
  TriangleMesh fan;
  fan.positions.push_back({0, 0, 0.2f});
  for (std::uint32_t k = 0; k < kSpokes; ++k) {
    const float angle = 6.2831853f * static_cast<float>(k) / static_cast<float>(kSpokes);
    fan.positions.push_back({std::cos(angle), std::sin(angle), 0});
    fan.faces.push_back({VertexId{0}, VertexId{1 + k}, VertexId{1 + (k + 1) % kSpokes}});
  }
  const WorkingMesh working = make_working_mesh(fan);
  const PerVertex<SurfacePoint> points = carry_back(working);
  for (VertexId v : fan.positions.ids())
    EXPECT_VEC3_NEAR(position_of(points[v], working), working.normalization.apply(fan.positions[v]), 0.01f);
}

TEST(CarryBack, both_sides_of_a_seam_and_unused_vertices_get_a_point) {
  TriangleMesh mesh = test::unshared(shapes::icosphere(4));
  const VertexId unused = mesh.positions.push_back(Vec3f(0, 2, 0));
  const WorkingMesh working = make_working_mesh(mesh);
  const auto points = carry_back(working);
  EXPECT_VEC3_NEAR(working.normalization.undo(position_of(points[unused], working)), Vec3f(0, 1, 0), 0.1f);
  std::map<std::array<float, 3>, const SurfacePoint*> at;
  for (VertexId v : mesh.positions.ids()) {
    const Vec3f& p = mesh.positions[v];
    const auto [entry, is_new] = at.try_emplace({p.x(), p.y(), p.z()}, &points[v]);
    EXPECT_EQ(entry->second->vertices, points[v].vertices);
    EXPECT_EQ(entry->second->weights, points[v].weights);
  }
}

}  // namespace
}  // namespace osteon::geometry
