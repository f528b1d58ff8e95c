// SPDX-License-Identifier: Apache-2.0
#include "osteon/mesh/triangle_mesh.h"

#include <cmath>
#include <numeric>
#include <vector>

#include "osteon/base/error.h"

namespace osteon {

void validate(const TriangleMesh& mesh) {
  if (mesh.positions.empty()) throw Error("mesh has no vertices");
  for (VertexId v : mesh.positions.ids())
    if (!mesh.positions[v].allFinite())
      throw Error("vertex {} is at ({}, {}, {}); expected finite coordinates", index(v), mesh.positions[v].x(), mesh.positions[v].y(),
                  mesh.positions[v].z());
  for (FaceId f : mesh.faces.ids())
    for (VertexId v : mesh.faces[f])
      if (index(v) >= mesh.positions.size())
        throw Error("face {} uses vertex {}, but the mesh has {} vertices", index(f), index(v), mesh.positions.size());
}

Eigen::AlignedBox3f bounds(const TriangleMesh& mesh) {
  Eigen::AlignedBox3f box;
  for (const Vec3f& p : mesh.positions) box.extend(p);
  return box;
}

Vec3f area_vector(const TriangleMesh& mesh, FaceId face) {
  const auto [a, b, c] = mesh.faces[face];
  return (mesh.positions[b] - mesh.positions[a]).cross(mesh.positions[c] - mesh.positions[a]);
}

double surface_area(const TriangleMesh& mesh) {
  double sum = 0.0;
  for (FaceId f : mesh.faces.ids()) sum += 0.5 * static_cast<double>(area_vector(mesh, f).norm());
  return sum;
}

PerVertex<Vec3f> vertex_normals(const TriangleMesh& mesh) {
  PerVertex<Vec3f> normals(mesh.positions.size(), Vec3f::Zero());
  for (FaceId f : mesh.faces.ids())
    for (VertexId v : mesh.faces[f]) normals[v] += area_vector(mesh, f);
  for (Vec3f& n : normals) {
    if (!std::isnormal(n.squaredNorm())) n.stableNormalize();  // the square of the area is too small or too large for a float
    const float length = n.norm();
    n = length > 0.0f ? Vec3f(n / length) : Vec3f::UnitY();
  }
  return normals;
}

Components connected_components(const TriangleMesh& mesh) {
  std::vector<std::uint32_t> parent(mesh.positions.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto find = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];  // path halving
    return v;
  };
  for (const Triangle& t : mesh.faces)
    for (int k = 1; k < 3; ++k) {
      const std::uint32_t a = find(static_cast<std::uint32_t>(t[0])), b = find(static_cast<std::uint32_t>(t[static_cast<std::size_t>(k)]));
      if (a != b) parent[std::max(a, b)] = std::min(a, b);
    }
  Components out{PerVertex<std::uint32_t>(mesh.positions.size()), 0};
  for (VertexId v : mesh.positions.ids()) {
    const std::uint32_t root = find(static_cast<std::uint32_t>(v));
    out.of[v] = root == static_cast<std::uint32_t>(v) ? out.count++ : out.of[VertexId{root}];  // the root has the smallest index
  }
  return out;
}

}  // namespace osteon
