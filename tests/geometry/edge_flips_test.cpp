// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/edge_flips.h"

#include <map>

#include "osteon/mesh/shapes.h"
#include "support/expect.h"

namespace osteon::geometry {
namespace {

// How many faces run along each edge in each direction.
std::map<std::pair<VertexId, VertexId>, int> directed_edges(const TriangleMesh& mesh) {
  std::map<std::pair<VertexId, VertexId>, int> counts;
  for (const Triangle& f : mesh.faces)
    for (std::size_t k = 0; k < 3; ++k) ++counts[{f[k], f[(k + 1) % 3]}];
  return counts;
}

std::size_t changed_faces(const TriangleMesh& a, const TriangleMesh& b) {
  std::size_t count = 0;
  for (FaceId f : a.faces.ids()) count += a.faces[f] != b.faces[f] ? 1 : 0;
  return count;
}

const TriangleMesh& round_mesh() {
  static const TriangleMesh mesh = shapes::capsule(0.2f, 1.0f, 32, 12);
  return mesh;
}

TriangleMesh flipped(const TriangleMesh& mesh, std::uint64_t seed, const EdgeFlipOptions& options = {}) {
  Random random(seed);
  return with_flipped_edges(mesh, options, random);
}

TEST(EdgeFlips, a_closed_manifold_stays_one_with_its_vertices) {
  for (std::uint64_t seed = 1; seed < 6; ++seed) {
    const TriangleMesh out = flipped(round_mesh(), seed);
    EXPECT_EQ(out.positions, round_mesh().positions);
    EXPECT_EQ(out.faces.size(), round_mesh().faces.size());
    EXPECT_GT(changed_faces(out, round_mesh()), out.faces.size() / 20);
    const auto edges = directed_edges(out);
    for (const auto& [edge, count] : edges) {
      EXPECT_EQ(count, 1);
      EXPECT_TRUE(edges.contains({edge.second, edge.first})) << "each edge has its two faces";
    }
  }
}

TEST(EdgeFlips, the_surface_stays_where_it_is) {
  const TriangleMesh out = flipped(round_mesh(), 3, {.share = 1.0f});
  EXPECT_NEAR(surface_area(out) / surface_area(round_mesh()), 1.0, 5e-3);
  const auto before = vertex_normals(round_mesh()), after = vertex_normals(out);
  for (VertexId v : before.ids()) EXPECT_GT(before[v].dot(after[v]), 0.99f);
}

// Two faces in one plane: the only edge that may go becomes the other diagonal.
//   3---2
//   |  /|
//   | / |
//   0---1
TEST(EdgeFlips, of_a_square_give_the_other_diagonal_and_the_same_area) {
  const auto v = [](std::uint32_t i) { return VertexId{i}; };
  const TriangleMesh square{PerVertex<Vec3f>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                            PerFace<Triangle>{{v(0), v(1), v(2)}, {v(0), v(2), v(3)}}};
  const TriangleMesh out = flipped(square, 1, {.share = 1.0f});
  const auto edges = directed_edges(out);
  EXPECT_TRUE(edges.contains({v(1), v(3)}) && edges.contains({v(3), v(1)}));
  EXPECT_FALSE(edges.contains({v(0), v(2)}));
  EXPECT_DOUBLE_EQ(surface_area(out), surface_area(square));
  for (FaceId f : out.faces.ids()) EXPECT_GT(area_vector(out, f).z(), 0.0f);
}

TEST(EdgeFlips, sharp_edges_and_edges_that_three_faces_share_stay) {
  const auto v = [](std::uint32_t i) { return VertexId{i}; };
  const TriangleMesh box = shapes::box(Vec3f(1, 1, 1));
  const auto corners = directed_edges(flipped(box, 1, {.share = 1.0f}));
  for (const auto& [edge, count] : directed_edges(box)) {
    const Vec3f way = box.positions[edge.first] - box.positions[edge.second];
    if (way.cwiseAbs().sum() < way.norm() * 1.01f) EXPECT_TRUE(corners.contains(edge)) << "an edge of the cube itself";
  }
  const TriangleMesh fins{PerVertex<Vec3f>{{0, 0, 0}, {0, 1, 0}, {1, 0.5f, 0}, {-1, 0.5f, 0}, {0, 0.5f, 1}},
                          PerFace<Triangle>{{v(0), v(2), v(1)}, {v(0), v(1), v(3)}, {v(0), v(1), v(4)}}};
  EXPECT_EQ(flipped(fins, 1, {.share = 1.0f}).faces, fins.faces);
}

TEST(EdgeFlips, depend_on_the_seed_alone) {
  EXPECT_EQ(flipped(round_mesh(), 7).faces, flipped(round_mesh(), 7).faces);
  EXPECT_NE(flipped(round_mesh(), 7).faces, flipped(round_mesh(), 8).faces);
  EXPECT_EQ(flipped(round_mesh(), 7, {.share = 0.0f}).faces, round_mesh().faces);
}

}  // namespace
}  // namespace osteon::geometry
