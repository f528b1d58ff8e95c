// SPDX-License-Identifier: Apache-2.0
#include "osteon/skin/heat.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cassert>

#include "osteon/skin/joint_solves.h"
#include "osteon/skin/surface_laplacian.h"

namespace osteon::skin {
namespace {

constexpr float kTie = 1.0001f;
constexpr double kLeastDistance = 1e-3;  // of the longest side: a vertex on a bone is not bound infinitely hard

// The joints whose bones are nearest, equal shares.
WeightRow nearest_joints(std::span<const BoneDistance> row, std::span<const Bone> bones) {
  WeightRow out;
  for (const auto& [bone, distance] : row) {
    if (distance > kTie * row.front().distance) break;
    if (std::ranges::find(out, bones[bone].start, &Influence::joint) == out.end()) out.push_back({bones[bone].start, 1.0f});
  }
  for (Influence& i : out) i.weight = 1.0f / static_cast<float>(out.size());
  return out;
}

}  // namespace

WeightRows heat_weights(const TriangleMesh& mesh, const BoneDistances& distances, std::span<const Bone> bones) {
  assert(distances.size() == mesh.positions.size());
  const Eigen::VectorXd areas = vertex_areas(mesh);
  const double least = kLeastDistance * static_cast<double>(mesh.positions.empty() ? 1.0f : bounds(mesh).sizes().maxCoeff());
  Eigen::VectorXd heat(areas.size());
  WeightRows sources(mesh.positions.size());
  for (VertexId v : mesh.positions.ids()) {
    const double d = std::max(least, static_cast<double>(distances.of(v).front().distance));
    heat[static_cast<Eigen::Index>(index(v))] = areas[static_cast<Eigen::Index>(index(v))] / (d * d);
    sources[v] = nearest_joints(distances.of(v), bones);
  }
  SparseMatrix system = surface_laplacian(mesh);
  for (Eigen::Index v = 0; v < heat.size(); ++v) system.coeffRef(v, v) += heat[v];
  const Eigen::SimplicialLDLT<SparseMatrix> solver(system);
  return solved_for_joints(sources, heat, solver);
}

}  // namespace osteon::skin
