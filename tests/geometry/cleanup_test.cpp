// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/cleanup.h"

#include <algorithm>
#include <cstring>

#include "geometry/mesh_makers.h"
#include "osteon/base/parallel.h"
#include "osteon/mesh/shapes.h"
#include "support/expect.h"

namespace osteon::geometry {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

void expect_same_bytes(const TriangleMesh& a, const TriangleMesh& b) {
  ASSERT_EQ(a.positions.size(), b.positions.size());
  EXPECT_EQ(std::memcmp(a.positions.data(), b.positions.data(), a.positions.size() * sizeof(Vec3f)), 0);
  EXPECT_EQ(a.faces, b.faces);
}

// Every original vertex stays where it is.
void expect_positions_kept(const TriangleMesh& original, const CleanMesh& clean) {
  for (VertexId v : original.positions.ids()) EXPECT_EQ(clean.mesh.positions[clean.from_original[v]], original.positions[v]);
}

TEST(Clean, sews_a_box_with_hard_edges_together) {
  const TriangleMesh box = test::unshared(shapes::box({1, 2, 3}));
  const CleanMesh clean = geometry::clean(box);
  EXPECT_EQ(clean.mesh.positions.size(), 8u);
  EXPECT_EQ(clean.mesh.faces.size(), 12u);
  EXPECT_THAT(clean.repairs, IsEmpty());
  expect_positions_kept(box, clean);
}

TEST(Clean, leaves_a_good_mesh_as_it_is_but_for_the_order) {
  const TriangleMesh sphere = shapes::icosphere(3);
  const CleanMesh clean = geometry::clean(sphere);
  EXPECT_EQ(clean.mesh.positions.size(), sphere.positions.size());
  EXPECT_EQ(clean.mesh.faces.size(), sphere.faces.size());
  EXPECT_NEAR(surface_area(clean.mesh), surface_area(sphere), 1e-5);
  expect_positions_kept(sphere, clean);
  const auto normals = vertex_normals(clean.mesh);
  for (VertexId v : clean.mesh.positions.ids()) EXPECT_GT(normals[v].dot(clean.mesh.positions[v]), 0.9f);
}

TEST(Clean, sorts_vertices_by_position) {
  const CleanMesh clean = geometry::clean(test::shuffled(shapes::icosphere(2), 3));
  const auto& p = clean.mesh.positions.raw();
  EXPECT_TRUE(std::is_sorted(p.begin(), p.end(), [](const Vec3f& a, const Vec3f& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end());
  }));
}

TEST(Clean, does_not_depend_on_the_order_of_vertices_and_faces) {
  for (const auto& [name, mesh] : test::awkward_meshes()) {
    SCOPED_TRACE(name);
    const CleanMesh clean = geometry::clean(mesh);
    for (std::uint64_t seed : {1, 2, 3}) {
      const CleanMesh other = geometry::clean(test::shuffled(mesh, seed));
      expect_same_bytes(clean.mesh, other.mesh);
      EXPECT_EQ(clean.repairs, other.repairs);
    }
  }
}

TEST(Clean, cleaning_twice_changes_nothing) {
  for (const auto& [name, mesh] : test::awkward_meshes()) {
    SCOPED_TRACE(name);
    const CleanMesh once = geometry::clean(mesh), twice = geometry::clean(once.mesh);
    expect_same_bytes(once.mesh, twice.mesh);
    EXPECT_THAT(twice.repairs, IsEmpty());
  }
}

TEST(Clean, does_not_depend_on_the_number_of_threads) {
  const TriangleMesh mesh = test::unshared(shapes::icosphere(5));
  const int before = threads();
  set_threads(1);
  const CleanMesh one = geometry::clean(mesh);
  set_threads(3);
  const CleanMesh three = geometry::clean(mesh);
  set_threads(before);
  expect_same_bytes(one.mesh, three.mesh);
  EXPECT_EQ(one.from_original, three.from_original);
}

TEST(Clean, parts_that_touch_at_equal_vertices_stay_apart) {
  const TriangleMesh stacked = shapes::merged(shapes::box({1, 1, 1}), shapes::shifted(shapes::box({1, 1, 1}), {0, 1, 0}));
  const CleanMesh clean = geometry::clean(stacked);
  EXPECT_EQ(connected_components(clean.mesh).count, 2u);
  EXPECT_EQ(clean.mesh.positions.size(), 16u);
  EXPECT_EQ(clean.mesh.faces.size(), 24u);  // the two caps face each other: both stay
  expect_positions_kept(stacked, clean);
}

TEST(Clean, open_parts_with_a_common_border_are_sewn) {
  const TriangleMesh left = shapes::sheet(4, 4), both = shapes::merged(left, shapes::shifted(left, {1, 0, 0}));
  const CleanMesh clean = geometry::clean(both);
  EXPECT_EQ(connected_components(clean.mesh).count, 1u);
  EXPECT_EQ(clean.mesh.positions.size(), 45u);
}

TEST(Clean, copies_of_a_whole_part_become_one) {
  const TriangleMesh sphere = shapes::icosphere(2), twice = shapes::merged(sphere, sphere);
  const CleanMesh clean = geometry::clean(twice);
  EXPECT_EQ(clean.mesh.faces.size(), sphere.faces.size());
  EXPECT_EQ(clean.mesh.positions.size(), sphere.positions.size());
  EXPECT_THAT(clean.repairs, ElementsAre(HasSubstr("320 faces are copies")));
  expect_positions_kept(twice, clean);
}

TEST(Clean, a_sheet_modelled_from_both_sides_becomes_one_sheet) {
  const TriangleMesh front = shapes::sheet(3, 3);
  for (const TriangleMesh& both :
       {shapes::merged(front, test::flipped(front)), test::unshared(shapes::merged(front, test::flipped(front)))}) {
    const CleanMesh clean = geometry::clean(both);
    EXPECT_EQ(clean.mesh.faces.size(), front.faces.size());
    EXPECT_EQ(clean.mesh.positions.size(), front.positions.size());
    expect_positions_kept(both, clean);
  }
}

TEST(Clean, repeated_faces_do_not_hinder_the_sewing_of_seams) {
  TriangleMesh box = test::unshared(shapes::box({1, 1, 1}));
  const auto faces = box.faces;
  for (const Triangle& t : faces) box.faces.push_back(t);
  EXPECT_EQ(geometry::clean(box).mesh.positions.size(), 8u);
}

TEST(Clean, faces_without_area_go_and_their_vertices_find_a_place) {
  TriangleMesh mesh = shapes::sheet(1, 1);
  const VertexId on_edge = mesh.positions.push_back(Vec3f(0.25f, 0, 0)), far = mesh.positions.push_back(Vec3f(3, 4, 0));
  mesh.faces.push_back({VertexId{0}, VertexId{1}, on_edge});
  mesh.faces.push_back({VertexId{0}, VertexId{0}, VertexId{3}});
  const CleanMesh clean = geometry::clean(mesh);
  EXPECT_EQ(clean.mesh.faces.size(), 2u);
  EXPECT_EQ(clean.mesh.positions.size(), 4u);
  EXPECT_EQ(clean.mesh.positions[clean.from_original[on_edge]], Vec3f(0, 0, 0));
  EXPECT_EQ(clean.mesh.positions[clean.from_original[far]], Vec3f(1, 1, 0));
  EXPECT_THAT(clean.repairs, ElementsAre("2 of 4 faces have no area and were left out", "2 vertices belong to no face with area"));
}

TEST(Clean, without_any_face_the_vertices_stay) {
  TriangleMesh mesh;
  mesh.positions = {Vec3f(2, 0, 0), Vec3f(1, 0, 0), Vec3f(2, 0, 0)};
  mesh.faces = {{VertexId{0}, VertexId{1}, VertexId{2}}};
  const CleanMesh clean = geometry::clean(mesh);
  EXPECT_TRUE(clean.mesh.faces.empty());
  EXPECT_THAT(clean.mesh.positions.raw(), ElementsAre(Vec3f(1, 0, 0), Vec3f(2, 0, 0)));
  EXPECT_THAT(clean.from_original.raw(), ElementsAre(VertexId{1}, VertexId{0}, VertexId{1}));
}

TEST(Clean, negative_zero_is_zero_and_seams_may_end_in_a_shared_vertex) {
  TriangleMesh mesh = shapes::sheet(1, 1);
  mesh.positions.push_back(Vec3f(0, -0.0f, -0.0f));
  mesh.faces.raw()[0][0] = VertexId{4};
  EXPECT_EQ(geometry::clean(mesh).mesh.positions.size(), 4u);
}

}  // namespace
}  // namespace osteon::geometry
