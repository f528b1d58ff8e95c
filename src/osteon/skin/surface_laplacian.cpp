// SPDX-License-Identifier: Apache-2.0
#include "osteon/skin/surface_laplacian.h"

#include <algorithm>
#include <map>
#include <vector>

namespace osteon::skin {
namespace {

constexpr double kLeastWeight = 0.01;

struct EdgeWeight {
  std::uint32_t a, b;  // a < b
  double weight;
};

double half_cotangent(const Vec3f& apex, const Vec3f& a, const Vec3f& b) {
  const Eigen::Vector3d u = (a - apex).cast<double>(), v = (b - apex).cast<double>();
  const double area = u.cross(v).norm();
  return area > 1e-14 * u.norm() * v.norm() && area > 0.0 ? 0.5 * u.dot(v) / area : 0.0;
}

// One entry for each edge, the weights of its faces added up.
std::vector<EdgeWeight> edge_weights(const TriangleMesh& mesh) {
  std::vector<EdgeWeight> out;
  out.reserve(3 * mesh.faces.size());
  for (const Triangle& face : mesh.faces)
    for (std::size_t k = 0; k < 3; ++k) {
      const VertexId a = face[k], b = face[(k + 1) % 3], apex = face[(k + 2) % 3];
      if (a == b) continue;
      out.push_back({static_cast<std::uint32_t>(std::min(a, b)), static_cast<std::uint32_t>(std::max(a, b)),
                     half_cotangent(mesh.positions[apex], mesh.positions[a], mesh.positions[b])});
    }
  std::ranges::stable_sort(out, {}, [](const EdgeWeight& e) { return std::pair(e.a, e.b); });
  std::size_t n = 0;
  for (const EdgeWeight& e : out)
    if (n > 0 && out[n - 1].a == e.a && out[n - 1].b == e.b)
      out[n - 1].weight += e.weight;
    else
      out[n++] = e;
  out.resize(n);
  return out;
}

}  // namespace

SparseMatrix surface_laplacian(const TriangleMesh& mesh) {
  const auto n = static_cast<Eigen::Index>(mesh.positions.size());
  std::vector<Eigen::Triplet<double>> entries;
  for (const EdgeWeight& e : edge_weights(mesh)) {
    const double w = std::max(kLeastWeight, e.weight);
    const auto a = static_cast<int>(e.a), b = static_cast<int>(e.b);
    entries.insert(entries.end(), {{a, b, -w}, {b, a, -w}, {a, a, w}, {b, b, w}});
  }
  SparseMatrix out(n, n);
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

Eigen::VectorXd vertex_areas(const TriangleMesh& mesh) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(mesh.positions.size()));
  for (FaceId f : mesh.faces.ids())
    for (VertexId v : mesh.faces[f]) out[static_cast<Eigen::Index>(index(v))] += static_cast<double>(area_vector(mesh, f).norm()) / 6.0;
  return out.cwiseMax(std::max(1e-30, 1e-6 * out.mean()));
}

}  // namespace osteon::skin
