// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/decimate.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "geometry/mesh_makers.h"
#include "osteon/base/parallel.h"
#include "osteon/geometry/cleanup.h"
#include "osteon/mesh/shapes.h"
#include "support/expect.h"

namespace osteon::geometry {
namespace {

void expect_every_vertex_used(const TriangleMesh& mesh) {
  PerVertex<std::uint8_t> used(mesh.positions.size());
  for (const Triangle& t : mesh.faces)
    for (VertexId v : t) used[v] = 1;
  EXPECT_EQ(std::count(used.begin(), used.end(), 0), 0);
}

TEST(Decimate, a_sphere_stays_a_sphere) {
  const auto [mesh, from] = decimate(shapes::icosphere(5), {.target_vertices = 600});
  EXPECT_EQ(mesh.positions.size(), 600u);
  EXPECT_EQ(mesh.faces.size(), 2 * 600u - 4);  // Euler: still closed and of genus 0
  for (const Vec3f& p : mesh.positions) EXPECT_NEAR(p.norm(), 1, 0.015f);
  EXPECT_NEAR(surface_area(mesh), surface_area(shapes::icosphere(5)), 0.2);
  const auto normals = vertex_normals(mesh);
  for (VertexId v : mesh.positions.ids()) EXPECT_GT(normals[v].dot(mesh.positions[v]), 0.95f);
}

TEST(Decimate, vertices_are_evenly_spread) {
  const auto [mesh, from] = decimate(shapes::icosphere(5), {.target_vertices = 600});
  const double usual = surface_area(mesh) / static_cast<double>(mesh.faces.size());
  for (FaceId f : mesh.faces.ids()) {
    const double area = 0.5 * static_cast<double>(area_vector(mesh, f).norm());
    EXPECT_GT(area, 0.25 * usual);
    EXPECT_LT(area, 4 * usual);
  }
}

TEST(Decimate, a_flat_sheet_keeps_its_outline) {
  const auto [mesh, from] = decimate(shapes::sheet(40, 40), {.target_vertices = 60});
  EXPECT_EQ(mesh.positions.size(), 60u);
  EXPECT_NEAR(surface_area(mesh), 1, 0.01);
  for (const Vec3f& p : mesh.positions) EXPECT_NEAR(p.z(), 0, 1e-6f);
}

TEST(Decimate, a_box_keeps_its_corners) {
  TriangleMesh box = shapes::box({1, 2, 3});
  for (int level = 0; level < 4; ++level) {  // each face into four, flat
    TriangleMesh finer;
    for (const auto& [a, b, c] : box.faces) {
      const Vec3f pa = box.positions[a], pb = box.positions[b], pc = box.positions[c];
      const Vec3f corners[4][3] = {{pa, (pa + pb) / 2, (pa + pc) / 2},
                                   {pb, (pb + pc) / 2, (pa + pb) / 2},
                                   {pc, (pa + pc) / 2, (pb + pc) / 2},
                                   {(pa + pb) / 2, (pb + pc) / 2, (pa + pc) / 2}};
      for (const auto& t : corners)
        finer.faces.push_back({finer.positions.push_back(t[0]), finer.positions.push_back(t[1]), finer.positions.push_back(t[2])});
    }
    box = clean(finer).mesh;
  }
  const auto [mesh, from] = decimate(box, {.target_vertices = 100});
  EXPECT_NEAR(surface_area(mesh), 22, 0.1);
  EXPECT_TRUE(bounds(mesh).isApprox(bounds(box), 0.02f));
}

TEST(Decimate, every_vertex_is_near_the_one_it_was_merged_into) {
  const TriangleMesh sphere = shapes::icosphere(5);
  const auto [mesh, from] = decimate(sphere, {.target_vertices = 600});
  ASSERT_EQ(from.size(), sphere.positions.size());
  for (VertexId v : sphere.positions.ids()) EXPECT_VEC3_NEAR(sphere.positions[v], mesh.positions[from[v]], 0.35f);
}

TEST(Decimate, a_mesh_that_is_small_enough_stays_as_it_is) {
  const TriangleMesh sphere = shapes::icosphere(2);
  const auto [mesh, from] = decimate(sphere, {.target_vertices = 162});
  EXPECT_EQ(mesh.positions, sphere.positions);
  EXPECT_EQ(mesh.faces, sphere.faces);
  for (VertexId v : from.ids()) EXPECT_EQ(from[v], v);
}

TEST(Decimate, no_piece_is_lost_or_joined_to_another) {
  for (const auto& [name, awkward] : test::awkward_meshes()) {
    SCOPED_TRACE(name);
    const TriangleMesh before = clean(awkward).mesh;
    for (std::size_t target : {50, 10, 1}) {
      const auto [mesh, from] = decimate(before, {.target_vertices = target});
      validate(mesh);
      expect_every_vertex_used(mesh);
      const Components old_parts = connected_components(before), new_parts = connected_components(mesh);
      EXPECT_EQ(new_parts.count, old_parts.count);
      std::vector<std::optional<std::uint32_t>> part(old_parts.count);
      for (VertexId v : before.positions.ids()) {
        std::optional<std::uint32_t>& becomes = part[old_parts.of[v]];
        if (!becomes) becomes = new_parts.of[from[v]];
        EXPECT_EQ(*becomes, new_parts.of[from[v]]);
      }
    }
  }
}

TEST(Decimate, open_and_non_manifold_meshes_reach_the_target) {
  for (const TriangleMesh& mesh : {test::moebius_strip(200), test::three_pages(20)}) {
    const DecimatedMesh reduced = decimate(mesh, {.target_vertices = 60});
    EXPECT_EQ(reduced.mesh.positions.size(), 60u);
    EXPECT_NEAR(surface_area(reduced.mesh) / surface_area(mesh), 1, 0.03);
  }
}

TEST(Decimate, ends_where_the_cheapest_edge_cannot_be_merged) {
  TriangleMesh book;  // all pages have the back's edge: hardly any two merges go together in a round
  for (const Vec3f& p : {Vec3f(0, 0, 0), Vec3f(0, 1, 0)}) book.positions.push_back(p);
  for (int page = 0; page < 200; ++page) {
    const float angle = 0.03f * static_cast<float>(page);
    const VertexId corner = book.positions.push_back({std::cos(angle), 0.5f, std::sin(angle)});
    book.faces.push_back({VertexId{0}, VertexId{1}, corner});
  }
  const VertexId loose = book.positions.push_back({2, 2, 2});  // a tiny triangle: its edges are the cheapest and its last
  book.faces.push_back({loose, book.positions.push_back({2.001f, 2, 2}), book.positions.push_back({2, 2.001f, 2})});
  EXPECT_LE(decimate(book, {.target_vertices = 60}).mesh.positions.size(), 70u);
}

TEST(Decimate, the_hub_of_a_fan_stays_where_it_is_and_the_fan_reaches_the_target) {
  constexpr std::uint32_t kSpokes = 5000;
  TriangleMesh fan;
  fan.positions.push_back(Vec3f::Zero());
  for (std::uint32_t k = 0; k < kSpokes; ++k) {
    const float angle = 2.0f * std::numbers::pi_v<float> * static_cast<float>(k) / static_cast<float>(kSpokes);
    fan.positions.push_back({std::cos(angle), std::sin(angle), 0});
    fan.faces.push_back({VertexId{0}, VertexId{1 + k}, VertexId{1 + (k + 1) % kSpokes}});
  }
  const auto [mesh, from] = decimate(fan, {.target_vertices = 100});
  EXPECT_EQ(mesh.positions.size(), 100u);
  EXPECT_VEC3_NEAR(mesh.positions[from[VertexId{0}]], Vec3f::Zero(), 1e-3f);
}

// Stretched a million times, nearly every merge would fold a face.
TEST(Decimate, folds_faces_only_where_more_vertices_would_be_left_than_may_be) {
  const TriangleMesh needle = shapes::transformed(shapes::icosphere(5), Transform(Eigen::Scaling(1e6f, 1.0f, 1.0f)));
  const std::size_t unfolded = decimate(needle, {.target_vertices = 100}).mesh.positions.size();
  ASSERT_GT(unfolded, 450u);
  EXPECT_EQ(decimate(needle, {.target_vertices = 100, .most_vertices = unfolded}).mesh.positions.size(), unfolded);
  const auto [mesh, from] = decimate(needle, {.target_vertices = 100, .most_vertices = 400});
  EXPECT_EQ(mesh.positions.size(), 400u);
  EXPECT_EQ(connected_components(mesh).count, 1u);
}

// Subdividing a face as thin as they come in models gives an even pattern of such faces; merging any two vertices makes some of them
// thinner.
TEST(Decimate, thin_faces_cut_finely_do_not_take_the_vertices_of_the_body) {
  const TriangleMesh body = shapes::icosphere(5);
  const TriangleMesh plate = shapes::transformed(shapes::sheet(64, 64), Transform(Eigen::Scaling(0.02f, 1.0f, 1.0f)));
  const TriangleMesh mesh = shapes::merged(body, shapes::shifted(plate, {2, 0, 0}));
  const DecimatedMesh reduced = decimate(mesh, {.target_vertices = 300});
  EXPECT_EQ(reduced.mesh.positions.size(), 300u);
  EXPECT_NEAR(surface_area(reduced.mesh) / surface_area(mesh), 1, 0.03);
}

TEST(Decimate, does_not_depend_on_the_unit) {
  for (const float scale : {1024.0f, 1.0f / 1024}) {  // exact in floats
    const TriangleMesh sphere = shapes::icosphere(4);
    const auto one = decimate(sphere, {.target_vertices = 300});
    const auto other = decimate(shapes::transformed(sphere, Transform(Eigen::UniformScaling<float>(scale))), {.target_vertices = 300});
    EXPECT_EQ(one.mesh.faces, other.mesh.faces);
    for (VertexId v : one.mesh.positions.ids()) EXPECT_EQ(scale * one.mesh.positions[v], other.mesh.positions[v]);
  }
}

TEST(Decimate, does_not_depend_on_the_number_of_threads) {
  const TriangleMesh mesh = clean(shapes::merged(shapes::icosphere(6), shapes::shifted(shapes::capsule(0.2f, 3, 60, 30), {3, 0, 0}))).mesh;
  const int before = threads();
  set_threads(1);
  const auto one = decimate(mesh, {.target_vertices = 500});
  set_threads(3);
  const auto three = decimate(mesh, {.target_vertices = 500});
  set_threads(before);
  EXPECT_EQ(one.mesh.positions, three.mesh.positions);
  EXPECT_EQ(one.mesh.faces, three.mesh.faces);
}

}  // namespace
}  // namespace osteon::geometry
