// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/subdivide.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "geometry/mesh_makers.h"
#include "osteon/mesh/shapes.h"
#include "support/expect.h"

namespace osteon::geometry {
namespace {

// Faces per undirected edge.
std::map<std::pair<VertexId, VertexId>, int> edge_uses(const TriangleMesh& mesh) {
  std::map<std::pair<VertexId, VertexId>, int> uses;
  for (const Triangle& t : mesh.faces)
    for (std::size_t k = 0; k < 3; ++k) ++uses[std::minmax(t[k], t[(k + 1) % 3])];
  return uses;
}

float longest_edge(const TriangleMesh& mesh) {
  float longest = 0;
  for (const auto& [ends, n] : edge_uses(mesh))
    longest = std::max(longest, (mesh.positions[ends.first] - mesh.positions[ends.second]).norm());
  return longest;
}

TEST(Subdivide, keeps_a_closed_mesh_closed_and_its_surface) {
  const TriangleMesh box = shapes::box({1, 2, 3}), fine = subdivide(box, {.most_vertices = 1000});
  EXPECT_EQ(fine.positions.size(), 1000u);
  EXPECT_EQ(fine.faces.size(), 2 * 1000u - 4);
  EXPECT_NEAR(surface_area(fine), 22, 1e-4);
  for (const auto& [ends, n] : edge_uses(fine)) EXPECT_EQ(n, 2);
  for (VertexId v : box.positions.ids()) EXPECT_EQ(fine.positions[v], box.positions[v]);
}

TEST(Subdivide, makes_edges_about_equally_long) {
  const TriangleMesh fine = subdivide(shapes::box({1, 2, 3}), {.most_vertices = 1000});
  const float spacing = std::sqrt(22.0f / 1000);
  EXPECT_LT(longest_edge(fine), 2 * spacing);
}

TEST(Subdivide, stops_when_no_edge_is_longer_than_wanted) {
  const TriangleMesh fine = subdivide(shapes::box({1, 2, 3}), {.most_vertices = 100000, .longest_edge = 0.5f});
  EXPECT_LE(longest_edge(fine), 0.5f);
  EXPECT_LT(fine.positions.size(), 1000u);
}

TEST(Subdivide, splits_all_faces_of_a_non_manifold_edge) {
  const TriangleMesh pages = test::three_pages(1), fine = subdivide(pages, {.most_vertices = 200});
  int with_three = 0;
  for (const auto& [ends, n] : edge_uses(fine)) {
    EXPECT_LE(n, 3);
    with_three += n == 3;
    if (n == 3) EXPECT_EQ(fine.positions[ends.first].x(), 0);
  }
  EXPECT_GE(with_three, 4);
  EXPECT_NEAR(surface_area(fine), 3, 1e-4);
}

TEST(Subdivide, leaves_a_mesh_that_is_fine_enough_or_without_faces) {
  EXPECT_EQ(subdivide(shapes::icosphere(2), {.most_vertices = 100}).positions.size(), 162u);
  TriangleMesh point;
  point.positions = {Vec3f(1, 2, 3)};
  EXPECT_EQ(subdivide(point, {.most_vertices = 100}).positions.size(), 1u);
}

TEST(Subdivide, ends_though_all_corners_of_a_face_coincide) {
  TriangleMesh mesh;
  mesh.positions = {Vec3f(1, 1, 1), Vec3f(1, 1, 1), Vec3f(1, 1, 1)};
  mesh.faces = {{VertexId{0}, VertexId{1}, VertexId{2}}};
  EXPECT_EQ(subdivide(mesh, {.most_vertices = 100}).positions.size(), 3u);
}

}  // namespace
}  // namespace osteon::geometry
