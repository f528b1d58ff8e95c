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

constexpr std::size_t kVerticesPerTask = 256;
constexpr float kLeastCosine = -0.5f;  // normals that differ by more disagree

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

  struct Bridge {
    VertexId vertex;
    std::uint32_t part;  // component of the face
    float distance;      // from the vertex to the face
    FaceId face;
    auto key() const { return std::tuple(vertex, part, distance, face); }
  };

  // From all vertices within reach of the face.
  void find(FaceId face, std::vector<Bridge>& bridges) const {
    Eigen::AlignedBox3f box;
    for (VertexId corner : mesh_.faces[face]) box.extend(mesh_.positions[corner]);
    box.min().array() -= reach_;
    box.max().array() += reach_;
    const Vec3f normal = area_vector(mesh_, face).stableNormalized();
    const std::uint32_t part = parts_.of[mesh_.faces[face][0]];
    const auto x = [&](VertexId v) { return mesh_.positions[v].x(); };
    for (auto v = std::ranges::lower_bound(by_x_, box.min().x(), {}, x); v != by_x_.end() && x(*v) <= box.max().x(); ++v) {
      if (parts_.of[*v] == part || !box.contains(mesh_.positions[*v]) || normals_[*v].dot(normal) <= kLeastCosine) continue;
      if (const float distance = distance_to(face, mesh_.positions[*v]); distance <= reach_) bridges.push_back({*v, part, distance, face});
    }
  }

 private:
  float distance_to(FaceId face, const Vec3f& p) const {
    const auto [ia, ib, ic] = mesh_.faces[face];
    const Vec3f &a = mesh_.positions[ia], &b = mesh_.positions[ib], &c = mesh_.positions[ic];
    const Vec3f w = closest_barycentric(p, a, b, c);
    return (w.x() * a + w.y() * b + w.z() * c - p).norm();
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
  std::vector<std::vector<BridgeFinder::Bridge>> found((mesh.faces.size() + kGrain - 1) / kGrain);
  parallel_for(mesh.faces.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) finder.find(static_cast<FaceId>(f), found[begin / kGrain]);
  });
  std::vector<BridgeFinder::Bridge> bridges;
  for (const auto& some : found) bridges.insert(bridges.end(), some.begin(), some.end());
  std::ranges::sort(bridges, {}, &BridgeFinder::Bridge::key);
  const auto farther = std::ranges::unique(bridges, {}, [](const auto& b) { return std::pair(b.vertex, b.part); });
  for (const auto& [vertex, part, length, face] : std::ranges::subrange(bridges.begin(), farther.begin()))
    for (VertexId corner : mesh.faces[face]) links.push_back({number(vertex), number(corner), distance(mesh, vertex, corner)});
}

SurfaceGraph graph_of(const TriangleMesh& mesh, const std::vector<Link>& links) {
  return with_links({std::vector<std::uint32_t>(mesh.positions.size() + 1, 0), {}}, links);
}

}  // namespace

SurfaceGraph surface_graph(const TriangleMesh& mesh, float bridge) {
  std::vector<Link> links;
  links.reserve(3 * mesh.faces.size());
  add_edges(mesh, links);
  add_bridges(mesh, bridge, links);
  return graph_of(mesh, links);
}

SurfaceGraph surface_graph(const TriangleMesh& mesh) {
  std::vector<Link> links;
  links.reserve(3 * mesh.faces.size());
  add_edges(mesh, links);
  return graph_of(mesh, links);
}

SurfaceGraph with_links(const SurfaceGraph& graph, std::span<const Link> links) {
  std::vector<std::uint32_t> ends(graph.offsets);
  std::vector<std::uint32_t> added(graph.size() + 1, 0);
  for (const Link& l : links) {
    ++added[l.from + 1];
    ++added[l.to + 1];
  }
  for (std::size_t v = 0; v < graph.size(); ++v) ends[v + 1] += added[v + 1] += added[v];
  std::vector<SurfaceGraph::Edge> edges(graph.edges.size() + 2 * links.size());
  std::vector<std::uint32_t> next(ends.begin(), ends.end() - 1);
  for (std::size_t v = 0; v < graph.size(); ++v)
    for (const SurfaceGraph::Edge& edge : graph.of(v)) edges[next[v]++] = edge;
  for (const Link& l : links) {
    edges[next[l.from]++] = {l.to, l.length};
    edges[next[l.to]++] = {l.from, l.length};
  }
  std::vector<std::uint32_t> kept(graph.size());
  parallel_for(graph.size(), kVerticesPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const auto row = std::span(edges).subspan(ends[v], ends[v + 1] - ends[v]);
      std::ranges::sort(row, {}, [](const SurfaceGraph::Edge& e) { return std::pair(e.to, e.length); });
      kept[v] = static_cast<std::uint32_t>(std::ranges::unique(row, {}, &SurfaceGraph::Edge::to).begin() - row.begin());
    }
  });
  SurfaceGraph out;
  out.edges.reserve(edges.size());
  for (std::size_t v = 0; v < graph.size(); ++v) {
    const auto row = std::span(edges).subspan(ends[v], kept[v]);
    out.edges.insert(out.edges.end(), row.begin(), row.end());
    out.offsets.push_back(static_cast<std::uint32_t>(out.edges.size()));
  }
  return out;
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
