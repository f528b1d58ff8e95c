// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/orientation.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

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

}  // namespace

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
