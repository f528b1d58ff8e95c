// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/surface_graph.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <optional>
#include <tuple>
#include <utility>

#include "osteon/base/parallel.h"
#include "osteon/geometry/bvh.h"

namespace osteon::geometry {
namespace {

constexpr float kLeastCosine = -0.5f;  // normals that differ by more disagree

struct Link {
  std::uint32_t from, to;
  float length;
  auto key() const { return std::tuple(from, to, length); }
};

std::uint32_t number(VertexId v) { return static_cast<std::uint32_t>(v); }

float distance(const TriangleMesh& mesh, VertexId a, VertexId b) { return (mesh.positions[a] - mesh.positions[b]).norm(); }

// One corner of a face seen from its opposite edge, whose ends are low < high.
struct HalfEdge {
  VertexId low, high, apex;
  auto key() const { return std::tuple(low, high, apex); }
  bool same_edge(const HalfEdge& other) const { return low == other.low && high == other.high; }
};

std::vector<HalfEdge> sorted_half_edges(const TriangleMesh& mesh) {
  std::vector<HalfEdge> out;
  out.reserve(3 * mesh.faces.size());
  for (const Triangle& t : mesh.faces)
    for (std::size_t k = 0; k < 3; ++k) {
      const VertexId a = t[k], b = t[(k + 1) % 3];
      if (a != b) out.push_back({std::min(a, b), std::max(a, b), t[(k + 2) % 3]});
    }
  std::ranges::sort(out, {}, &HalfEdge::key);
  return out;
}

// The straight line from a.apex to b.apex over their common edge, with both faces laid into a plane; none where it leaves them.
std::optional<float> unfolded_distance(const TriangleMesh& mesh, const HalfEdge& a, const HalfEdge& b) {
  Vec3f low = mesh.positions[a.low], high = mesh.positions[a.high];
  if (std::ranges::lexicographical_compare(high, low)) std::swap(low, high);  // the same rounding however vertices are numbered
  const Vec3f edge = high - low;
  const float length = edge.norm();
  if (length == 0.0f) return std::nullopt;
  const auto in_plane = [&](VertexId apex) {  // along the edge, away from it
    const Vec3f d = mesh.positions[apex] - low;
    return std::pair(d.dot(edge) / length, d.cross(edge).norm() / length);
  };
  const auto [xa, ya] = in_plane(a.apex);
  const auto [xb, yb] = in_plane(b.apex);
  if (ya + yb <= 0.0f) return std::nullopt;
  const float crossing = (xa * yb + xb * ya) / (ya + yb);
  if (crossing <= 0.0f || crossing >= length) return std::nullopt;
  return std::hypot(xa - xb, ya + yb);
}

void add_edges(const TriangleMesh& mesh, std::vector<Link>& links) {
  const std::vector<HalfEdge> sides = sorted_half_edges(mesh);
  for (std::size_t first = 0, last = 0; first < sides.size(); first = last) {
    while (last < sides.size() && sides[last].same_edge(sides[first])) ++last;
    const HalfEdge& a = sides[first];
    links.push_back({number(a.low), number(a.high), distance(mesh, a.low, a.high)});
    if (last - first != 2 || a.apex == sides[first + 1].apex) continue;
    if (const auto across = unfolded_distance(mesh, a, sides[first + 1]))
      links.push_back({number(a.apex), number(sides[first + 1].apex), *across});
  }
}

// Normals of unit length, or zero for vertices without faces and for faces without area: these agree with every normal.
PerVertex<Vec3f> normals_or_zero(const TriangleMesh& mesh) {
  PerVertex<Vec3f> normals(mesh.positions.size(), Vec3f::Zero());
  for (FaceId f : mesh.faces.ids())
    for (VertexId v : mesh.faces[f]) normals[v] += area_vector(mesh, f);
  for (Vec3f& n : normals) n.stableNormalize();
  return normals;
}

class BridgeFinder {
 public:
  BridgeFinder(const TriangleMesh& mesh, const Components& parts, float reach)
      : mesh_(mesh), parts_(parts), reach_(reach), normals_(normals_or_zero(mesh)) {
    for (VertexId v : mesh.positions.ids()) by_x_.push_back(v);
    std::ranges::sort(by_x_, {}, [&](VertexId v) { return std::pair(mesh.positions[v].x(), v); });
  }

  void find(FaceId face, std::vector<Link>& links) const {
    Eigen::AlignedBox3f box;
    for (VertexId corner : mesh_.faces[face]) box.extend(mesh_.positions[corner]);
    box.min().array() -= reach_;
    box.max().array() += reach_;
    const Vec3f normal = area_vector(mesh_, face).stableNormalized();
    const auto x = [&](VertexId v) { return mesh_.positions[v].x(); };
    for (auto v = std::ranges::lower_bound(by_x_, box.min().x(), {}, x); v != by_x_.end() && x(*v) <= box.max().x(); ++v)
      if (box.contains(mesh_.positions[*v]) && joins(*v, face, normal))
        for (VertexId corner : mesh_.faces[face]) links.push_back({number(*v), number(corner), distance(mesh_, *v, corner)});
  }

 private:
  bool joins(VertexId v, FaceId face, const Vec3f& normal) const {
    const auto [a, b, c] = mesh_.faces[face];
    if (parts_.of[v] == parts_.of[a] || normals_[v].dot(normal) <= kLeastCosine) return false;
    const Vec3f &p = mesh_.positions[v], &pa = mesh_.positions[a], &pb = mesh_.positions[b], &pc = mesh_.positions[c];
    const Vec3f w = closest_barycentric(p, pa, pb, pc);
    return (w.x() * pa + w.y() * pb + w.z() * pc - p).norm() <= reach_;
  }

  const TriangleMesh& mesh_;
  const Components& parts_;
  float reach_;
  PerVertex<Vec3f> normals_;
  std::vector<VertexId> by_x_;
};

void add_bridges(const TriangleMesh& mesh, float reach, std::vector<Link>& links) {
  const Components parts = connected_components(mesh);
  if (parts.count < 2) return;
  const BridgeFinder finder(mesh, parts, reach);
  constexpr std::size_t kGrain = 64;
  std::vector<std::vector<Link>> found((mesh.faces.size() + kGrain - 1) / kGrain);
  parallel_for(mesh.faces.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) finder.find(static_cast<FaceId>(f), found[begin / kGrain]);
  });
  for (const auto& some : found) links.insert(links.end(), some.begin(), some.end());
}

// Both directions of every link, the shortest of those between the same two vertices.
SurfaceGraph graph_of(std::vector<Link> links, std::size_t vertices) {
  const std::size_t n = links.size();
  links.reserve(2 * n);
  for (std::size_t i = 0; i < n; ++i) links.push_back({links[i].to, links[i].from, links[i].length});
  std::ranges::sort(links, {}, &Link::key);
  const auto copies = std::ranges::unique(links, {}, [](const Link& l) { return std::pair(l.from, l.to); });
  links.erase(copies.begin(), copies.end());
  SurfaceGraph graph;
  graph.offsets.assign(vertices + 1, 0);
  for (const Link& l : links) {
    ++graph.offsets[l.from + 1];
    graph.edges.push_back({l.to, l.length});
  }
  for (std::size_t v = 0; v < vertices; ++v) graph.offsets[v + 1] += graph.offsets[v];
  return graph;
}

}  // namespace

SurfaceGraph surface_graph(const TriangleMesh& mesh, float bridge) {
  std::vector<Link> links;
  links.reserve(3 * mesh.faces.size());
  add_edges(mesh, links);
  add_bridges(mesh, bridge, links);
  return graph_of(std::move(links), mesh.positions.size());
}

// Dijkstra, "A note on two problems in connexion with graphs", 1959, with a binary heap whose outdated entries are skipped.
std::vector<float> shortest_paths(const SurfaceGraph& graph, std::vector<float> start) {
  assert(start.size() == graph.size());
  using Entry = std::pair<float, std::uint32_t>;
  std::vector<Entry> heap;
  for (std::size_t v = 0; v < start.size(); ++v)
    if (std::isfinite(start[v])) heap.emplace_back(start[v], static_cast<std::uint32_t>(v));
  std::ranges::make_heap(heap, std::greater{});
  while (!heap.empty()) {
    std::ranges::pop_heap(heap, std::greater{});
    const auto [here, v] = heap.back();
    heap.pop_back();
    if (here > start[v]) continue;
    for (const auto& [to, length] : graph.of(v))
      if (here + length < start[to]) {
        start[to] = here + length;
        heap.emplace_back(start[to], to);
        std::ranges::push_heap(heap, std::greater{});
      }
  }
  return start;
}

}  // namespace osteon::geometry
