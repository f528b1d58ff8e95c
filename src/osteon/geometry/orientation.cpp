// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/orientation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "osteon/base/parallel.h"
#include "osteon/geometry/buckets.h"

namespace osteon::geometry {
namespace {

constexpr std::size_t kGrain = 1 << 12;
constexpr double kClearly = 0.005;  // of the area to the power of 1.5 (a sphere has 0.094): sheets hardly enclose anything
constexpr double kTurned = 0.05;    // of the area: at most 0.033 looks against what is beside it in 404 characters
constexpr double kShare = 0.25;     // of the area: less than a fifth is so in 430 characters that stand right

// Six times the volume that each component encloses; negative where it is inside out.
std::vector<double> volumes(const TriangleMesh& mesh, const Components& parts) {
  std::vector<Eigen::Vector3d> pivots(parts.count);  // near the part, so that an open one is judged by its shape and not by where it is
  std::vector<double> counts(parts.count, 0.0), out(parts.count, 0.0);
  for (Eigen::Vector3d& pivot : pivots) pivot.setZero();
  for (VertexId v : mesh.positions.ids()) {
    pivots[parts.of[v]] += mesh.positions[v].cast<double>();
    ++counts[parts.of[v]];
  }
  for (std::uint32_t p = 0; p < parts.count; ++p) pivots[p] /= counts[p];
  for (const auto& [a, b, c] : mesh.faces) {
    const std::uint32_t part = parts.of[a];
    const auto from = [&](VertexId v) -> Eigen::Vector3d { return mesh.positions[v].cast<double>() - pivots[part]; };
    out[part] += from(a).dot(from(b).cross(from(c)));
  }
  return out;
}

std::vector<double> areas(const TriangleMesh& mesh, const Components& parts) {
  std::vector<double> out(parts.count, 0.0);
  for (const auto& [a, b, c] : mesh.faces) {
    const Eigen::Vector3d p = mesh.positions[a].cast<double>();
    out[parts.of[a]] += 0.5 * (mesh.positions[b].cast<double>() - p).cross(mesh.positions[c].cast<double>() - p).norm();
  }
  return out;
}

// A face beside another one across an edge that no third has.
struct Neighbour {
  FaceId face;
  bool looks_alike;  // runs through the edge the other way, as faces do that look to the same side
};

// One corner of a face to the next one.
struct HalfEdge {
  VertexId high;  // the lower one is the key of its bucket
  FaceId face;
  bool rises;
};

// By their lower ends, those along one edge side by side.
Buckets<HalfEdge> half_edges(const TriangleMesh& mesh) {
  auto edges = bucketed<HalfEdge>(mesh.positions.size(), [&](auto put) {
    for (FaceId f : mesh.faces.ids())
      for (std::size_t k = 0; k < 3; ++k) {
        const VertexId from = mesh.faces[f][k], to = mesh.faces[f][(k + 1) % 3];
        put(index(std::min(from, to)), HalfEdge{std::max(from, to), f, from < to});
      }
  });
  parallel_for(edges.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      std::ranges::sort(edges.of(v), {}, [](const HalfEdge& e) { return std::pair(e.high, e.face); });
  });
  return edges;
}

// Calls visit(a, b) for the two half-edges of each edge that exactly two faces have.
template <class Visit>
void for_each_pair(const Buckets<HalfEdge>& edges, const Visit& visit) {
  for (std::size_t v = 0; v < edges.size(); ++v) {
    const auto group = edges.of(v);
    for (std::size_t i = 0, next = 0; i < group.size(); i = next) {
      while (next < group.size() && group[next].high == group[i].high) ++next;
      if (next - i == 2) visit(group[i], group[i + 1]);
    }
  }
}

bool all_look_alike(const Buckets<HalfEdge>& edges) {
  bool alike = true;
  for_each_pair(edges, [&](const HalfEdge& a, const HalfEdge& b) { alike = alike && a.rises != b.rises; });
  return alike;
}

Buckets<Neighbour> neighbours_of(std::size_t faces, const Buckets<HalfEdge>& edges) {
  return bucketed<Neighbour>(faces, [&](auto put) {
    for_each_pair(edges, [&](const HalfEdge& a, const HalfEdge& b) {
      put(index(a.face), Neighbour{b.face, a.rises != b.rises});
      put(index(b.face), Neighbour{a.face, a.rises != b.rises});
    });
  });
}

// Faces that hang together, from the first one on.
struct Patch {
  std::vector<FaceId> faces;
  std::vector<bool> turned;  // against the first
  bool has_sides = true;     // a Moebius strip has none
};

Patch patch_around(FaceId first, const Buckets<Neighbour>& neighbours, PerFace<std::optional<bool>>& turned) {
  Patch patch;
  const auto reach = [&](FaceId f, bool is_turned) {
    turned[f] = is_turned;
    patch.faces.push_back(f);
    patch.turned.push_back(is_turned);
  };
  reach(first, false);
  for (std::size_t i = 0; i < patch.faces.size(); ++i)
    for (const auto& [next, looks_alike] : neighbours.of(index(patch.faces[i]))) {
      const bool is_turned = patch.turned[i] == looks_alike;
      if (!turned[next]) reach(next, is_turned);
      if (*turned[next] != is_turned) patch.has_sides = false;
    }
  return patch;
}

}  // namespace

std::size_t turn_against_neighbours(TriangleMesh& mesh) {
  const Buckets<HalfEdge> edges = half_edges(mesh);
  if (all_look_alike(edges)) return 0;
  const Buckets<Neighbour> neighbours = neighbours_of(mesh.faces.size(), edges);
  PerFace<std::optional<bool>> reached(mesh.faces.size());
  std::vector<FaceId> lesser;  // of each patch the faces that look against most of it
  double all_area = 0, lesser_area = 0;
  for (FaceId first : mesh.faces.ids()) {
    if (reached[first]) continue;
    const Patch patch = patch_around(first, neighbours, reached);
    std::array<double, 2> areas{};  // of the faces that look as the first one does, and of the others
    for (std::size_t i = 0; i < patch.faces.size(); ++i)
      areas[patch.turned[i]] += static_cast<double>(area_vector(mesh, patch.faces[i]).norm());
    all_area += areas[0] + areas[1];
    if (!patch.has_sides) continue;
    const bool are_turned = areas[1] <= areas[0];
    lesser_area += areas[are_turned];
    for (std::size_t i = 0; i < patch.faces.size(); ++i)
      if (patch.turned[i] == are_turned) lesser.push_back(patch.faces[i]);
  }
  if (lesser_area < kTurned * all_area) return 0;
  for (FaceId f : lesser) std::swap(mesh.faces[f][1], mesh.faces[f][2]);
  return lesser.size();
}

TriangleMesh faced_outwards(TriangleMesh mesh, const Components& parts) {
  const std::vector<double> volume = volumes(mesh, parts);
  for (Triangle& face : mesh.faces)
    if (volume[parts.of[face[0]]] < 0.0) std::swap(face[1], face[2]);
  return mesh;
}

std::size_t turn_inside_out(TriangleMesh& mesh) {
  const Components parts = connected_components(mesh);
  const std::vector<double> volume = volumes(mesh, parts), area = areas(mesh, parts);
  const auto is_inside_out = [&](std::size_t part) { return volume[part] < -6.0 * kClearly * std::pow(area[part], 1.5); };
  double turned_area = 0.0;
  for (std::size_t part = 0; part < parts.count; ++part)
    if (is_inside_out(part)) turned_area += area[part];
  if (turned_area == 0.0 || turned_area < kShare * std::accumulate(area.begin(), area.end(), 0.0)) return 0;
  std::size_t count = 0;
  for (Triangle& face : mesh.faces) {
    if (!is_inside_out(parts.of[face[0]])) continue;
    std::swap(face[1], face[2]);
    ++count;
  }
  return count;
}

}  // namespace osteon::geometry
