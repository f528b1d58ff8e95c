// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/orientation.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "osteon/geometry/buckets.h"

namespace osteon::geometry {
namespace {

constexpr double kClearly = 0.005;  // of the area to the power of 1.5 (a sphere has 0.094): sheets hardly enclose anything
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

Buckets<Neighbour> neighbours_of(const TriangleMesh& mesh) {
  struct HalfEdge {
    VertexId low, high;
    FaceId face;
    bool rises;
    auto ends() const { return std::pair(low, high); }
  };
  std::vector<HalfEdge> edges;
  for (FaceId f : mesh.faces.ids())
    for (std::size_t k = 0; k < 3; ++k) {
      const VertexId from = mesh.faces[f][k], to = mesh.faces[f][(k + 1) % 3];
      edges.push_back({std::min(from, to), std::max(from, to), f, from < to});
    }
  std::ranges::stable_sort(edges, {}, &HalfEdge::ends);
  return bucketed<Neighbour>(mesh.faces.size(), [&](auto put) {
    for (std::size_t i = 0, next = 0; i < edges.size(); i = next) {
      while (next < edges.size() && edges[next].ends() == edges[i].ends()) ++next;
      if (next - i != 2) continue;
      const HalfEdge &a = edges[i], &b = edges[i + 1];
      put(index(a.face), Neighbour{b.face, a.rises != b.rises});
      put(index(b.face), Neighbour{a.face, a.rises != b.rises});
    }
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
  const Buckets<Neighbour> neighbours = neighbours_of(mesh);
  PerFace<std::optional<bool>> reached(mesh.faces.size());
  std::size_t count = 0;
  for (FaceId first : mesh.faces.ids()) {
    if (reached[first]) continue;
    const Patch patch = patch_around(first, neighbours, reached);
    if (!patch.has_sides) continue;
    double area = 0, turned_area = 0;
    for (std::size_t i = 0; i < patch.faces.size(); ++i) {
      const auto part = static_cast<double>(area_vector(mesh, patch.faces[i]).norm());
      area += part;
      if (patch.turned[i]) turned_area += part;
    }
    const bool lesser = turned_area <= 0.5 * area;  // the first face is with the greater part
    for (std::size_t i = 0; i < patch.faces.size(); ++i) {
      if (patch.turned[i] != lesser) continue;
      Triangle& face = mesh.faces[patch.faces[i]];
      std::swap(face[1], face[2]);
      ++count;
    }
  }
  return count;
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
