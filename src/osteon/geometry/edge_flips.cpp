// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/edge_flips.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <set>
#include <span>
#include <utility>
#include <vector>

namespace osteon::geometry {
namespace {

using Ends = std::pair<VertexId, VertexId>;  // of an edge, the smaller first

Ends ends(VertexId a, VertexId b) { return {std::min(a, b), std::max(a, b)}; }

// A side of a face: from corner k to the next.
struct Side {
  Ends edge;
  FaceId face;
  std::size_t k;
};

std::vector<Side> sides_by_edge(const TriangleMesh& mesh) {
  std::vector<Side> sides;
  for (FaceId f : mesh.faces.ids())
    for (std::size_t k = 0; k < 3; ++k) sides.push_back({ends(mesh.faces[f][k], mesh.faces[f][(k + 1) % 3]), f, k});
  std::ranges::stable_sort(sides, {}, &Side::edge);
  return sides;
}

// Two faces that share an edge and run along it in opposite directions.
struct Hinge {
  Side side, other;
};

std::vector<Hinge> hinges(const TriangleMesh& mesh, std::span<const Side> sides) {
  std::vector<Hinge> out;
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t next = i + 1;
    while (next < sides.size() && sides[next].edge == sides[i].edge) ++next;
    const bool two = next == i + 2 && mesh.faces[sides[i].face][sides[i].k] != mesh.faces[sides[i + 1].face][sides[i + 1].k];
    if (two) out.push_back({sides[i], sides[i + 1]});
    i = next;
  }
  return out;
}

float longest_side(const TriangleMesh& mesh, const Triangle& face) {
  float longest = 0.0f;
  for (std::size_t k = 0; k < 3; ++k) longest = std::max(longest, (mesh.positions[face[k]] - mesh.positions[face[(k + 1) % 3]]).norm());
  return longest;
}

Vec3f area_vector(const TriangleMesh& mesh, const Triangle& face) {
  const Vec3f& a = mesh.positions[face[0]];
  return (mesh.positions[face[1]] - a).cross(mesh.positions[face[2]] - a);
}

bool is_round(const TriangleMesh& mesh, const Triangle& face, float roundness) {
  const float longest = longest_side(mesh, face);
  return area_vector(mesh, face).norm() >= roundness * longest * longest;
}

// Whether the faces have area and lie nearly in one plane.
bool are_coplanar(const TriangleMesh& mesh, std::span<const Triangle> faces, float bend) {
  std::vector<Vec3f> normals;
  for (const Triangle& face : faces) normals.push_back(area_vector(mesh, face).normalized());
  const float least = std::cos(bend);
  for (std::size_t i = 0; i < normals.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (!(normals[i].dot(normals[j]) >= least)) return false;
  return true;
}

}  // namespace

TriangleMesh with_flipped_edges(TriangleMesh mesh, const EdgeFlipOptions& options, Random& random) {
  const std::vector<Side> sides = sides_by_edge(mesh);
  std::set<Ends> edges;
  for (const Side& side : sides) edges.insert(edges.end(), side.edge);
  std::vector<Hinge> order = hinges(mesh, sides);
  random.shuffle<Hinge>(order);
  PerFace<bool> flipped(mesh.faces.size(), false);
  for (const auto& [side, other] : order) {
    if (random.uniform() >= options.share || flipped[side.face] || flipped[other.face]) continue;
    const Triangle one = mesh.faces[side.face], two = mesh.faces[other.face];
    const VertexId a = one[side.k], b = two[other.k], c = one[(side.k + 2) % 3], d = two[(other.k + 2) % 3];
    if (c == d || edges.contains(ends(c, d))) continue;
    const Triangle first{a, d, c}, second{b, c, d};
    if (!is_round(mesh, first, options.roundness) || !is_round(mesh, second, options.roundness)) continue;
    if (!are_coplanar(mesh, std::array{one, two, first, second}, options.bend)) continue;
    mesh.faces[side.face] = first;
    mesh.faces[other.face] = second;
    flipped[side.face] = flipped[other.face] = true;
    edges.erase(side.edge);
    edges.insert(ends(c, d));
  }
  return mesh;
}

}  // namespace osteon::geometry
