// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/body_graph.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>
#include <vector>

#include "osteon/base/parallel.h"
#include "osteon/geometry/union_find.h"

namespace osteon::geometry {
namespace {

constexpr std::size_t kGrain = 64;
constexpr int kSlanted = 6;      // lines around the one straight inwards ...
constexpr float kSlant = 0.87f;  // ... at this angle to it: 50 degrees

std::uint32_t number(VertexId v) { return static_cast<std::uint32_t>(v); }

std::array<Vec3f, kSlanted + 1> inward_directions(const Vec3f& normal) {
  const Vec3f u = normal.unitOrthogonal(), v = normal.cross(u);
  std::array<Vec3f, kSlanted + 1> out;
  for (int k = 0; k < kSlanted; ++k) {
    const float angle = 2.0f * std::numbers::pi_v<float> * static_cast<float>(k) / kSlanted;
    out[static_cast<std::size_t>(k)] = std::sin(kSlant) * (std::cos(angle) * u + std::sin(angle) * v) - std::cos(kSlant) * normal;
  }
  out.back() = -normal;
  return out;
}

void add_chords_from(VertexId v, const TriangleMesh& mesh, const BodyLines& lines, std::vector<Link>& links) {
  if (lines.normal(v).isZero(0.0f)) return;
  for (const Vec3f& direction : inward_directions(lines.normal(v)))
    if (const auto hit = lines.opposite(v, direction))
      for (VertexId corner : mesh.faces[hit->face])
        links.push_back({number(v), number(corner), (mesh.positions[v] - mesh.positions[corner]).norm()});
}

// The surface and the chords through the body: the surface by one thread, while the others cast rays.
SurfaceGraph surface_and_chords(const TriangleMesh& mesh, const BodyLines& lines, float bridge) {
  SurfaceGraph surface;
  std::vector<std::vector<Link>> found((mesh.positions.size() + kGrain - 1) / kGrain);
  parallel_for(found.size() + 1, 1, [&](std::size_t task, std::size_t) {
    if (task == 0) {
      surface = surface_graph(mesh, bridge);
      return;
    }
    const std::size_t begin = (task - 1) * kGrain, end = std::min(begin + kGrain, mesh.positions.size());
    for (std::size_t v = begin; v < end; ++v) add_chords_from(static_cast<VertexId>(v), mesh, lines, found[task - 1]);
  });
  std::vector<Link> chords;
  for (const auto& some : found) chords.insert(chords.end(), some.begin(), some.end());
  return with_links(surface, chords);
}

UnionFind pieces_of(const SurfaceGraph& graph) {
  UnionFind pieces(graph.size());
  for (std::uint32_t v = 0; v < graph.size(); ++v)
    for (const auto& edge : graph.of(v)) pieces.join(v, edge.to);
  return pieces;
}

bool shorter(const Link& a, const Link& b) { return std::tuple(a.length, a.from, a.to) < std::tuple(b.length, b.from, b.to); }

// From each vertex to the nearest of another piece.
std::vector<Link> nearest_elsewhere(const TriangleMesh& mesh, const std::vector<std::uint32_t>& pieces) {
  std::vector<Link> links(pieces.size());
  parallel_for(pieces.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      links[v] = {static_cast<std::uint32_t>(v), static_cast<std::uint32_t>(v), std::numeric_limits<float>::infinity()};
      for (std::size_t u = 0; u < pieces.size(); ++u)
        if (const float squared = (mesh.positions.raw()[u] - mesh.positions.raw()[v]).squaredNorm();
            pieces[u] != pieces[v] && squared < links[v].length)
          links[v] = {static_cast<std::uint32_t>(v), static_cast<std::uint32_t>(u), squared};
      links[v].length = std::sqrt(links[v].length);
    }
  });
  return links;
}

// The shortest links that join all pieces: Boruvka 1926 (each round every piece reaches for its nearest neighbour, so pieces at least
// halve).
std::vector<Link> links_between_pieces(const TriangleMesh& mesh, const SurfaceGraph& graph) {
  UnionFind pieces = pieces_of(graph);
  std::vector<Link> links;
  for (std::vector<std::uint32_t> of = pieces.all(); std::ranges::any_of(of, [](std::uint32_t p) { return p != 0; }); of = pieces.all()) {
    std::vector<Link> candidates = nearest_elsewhere(mesh, of);
    std::vector<Link> best(of.size(), {0, 0, std::numeric_limits<float>::infinity()});
    for (const Link& link : candidates)
      if (shorter(link, best[of[link.from]])) best[of[link.from]] = link;
    for (const Link& link : best)
      if (std::isfinite(link.length) && pieces.join(link.from, link.to)) links.push_back(link);
  }
  return links;
}

}  // namespace

SurfaceGraph body_graph(const TriangleMesh& mesh, const BodyLines& lines, float bridge) {
  SurfaceGraph body = surface_and_chords(mesh, lines, bridge);
  const std::vector<Link> links = links_between_pieces(mesh, body);
  return links.empty() ? body : with_links(body, links);
}

}  // namespace osteon::geometry
