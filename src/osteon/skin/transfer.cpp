// SPDX-License-Identifier: Apache-2.0
#include "osteon/skin/transfer.h"

#include <Eigen/SparseCholesky>
#include <cmath>

#include "osteon/base/parallel.h"
#include "osteon/geometry/bvh.h"
#include "osteon/skin/joint_solves.h"
#include "osteon/skin/surface_laplacian.h"

namespace osteon::skin {
namespace {

constexpr std::size_t kVerticesPerTask = 256;

struct Matches {
  WeightRows rows;             // of the closest points
  std::vector<bool> is_close;  // near enough, with the same normal
};

WeightRow weights_at(const geometry::ClosestPoint& point, const Rig& reference, const PerJoint<JointId>& joint_of) {
  WeightRow row;
  for (std::size_t k = 0; k < 3; ++k)
    if (const float share = point.barycentric[static_cast<Eigen::Index>(k)]; share > 0.0f)
      for (const Influence& i : reference.weights[reference.mesh.faces[point.face][k]])
        row.push_back({joint_of[i.joint], share * i.weight});
  merge(row);
  normalize(row);
  return row;
}

Matches closest(const TriangleMesh& mesh, const Rig& reference, const PerJoint<JointId>& joint_of, const TransferOptions& options) {
  const geometry::Bvh surface(reference.mesh);
  const PerVertex<Vec3f> normals = vertex_normals(mesh), theirs = vertex_normals(reference.mesh);
  const float reach = options.reach * bounds(mesh).diagonal().norm(), cosine = std::cos(options.angle);
  std::vector<std::uint8_t> close(mesh.positions.size(), 0);
  Matches out{WeightRows(mesh.positions.size()), {}};
  parallel_for(mesh.positions.size(), kVerticesPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto v = static_cast<VertexId>(i);
      const geometry::ClosestPoint point = surface.closest_point(mesh.positions[v]);
      Vec3f normal = Vec3f::Zero();
      for (std::size_t k = 0; k < 3; ++k)
        normal += point.barycentric[static_cast<Eigen::Index>(k)] * theirs[reference.mesh.faces[point.face][k]];
      out.rows[v] = weights_at(point, reference, joint_of);
      close[i] = point.distance <= reach && std::abs(normal.stableNormalized().dot(normals[v])) >= cosine;
    }
  });
  out.is_close.assign(close.begin(), close.end());
  return out;
}

// A piece where nobody is close would have nothing to continue.
void accept_pieces_without_match(const TriangleMesh& mesh, std::vector<bool>& is_close) {
  const Components parts = connected_components(mesh);
  std::vector<bool> has_match(parts.count, false);
  for (VertexId v : mesh.positions.ids())
    if (is_close[index(v)]) has_match[parts.of[v]] = true;
  for (VertexId v : mesh.positions.ids())
    if (!has_match[parts.of[v]]) is_close[index(v)] = true;
}

SparseMatrix smoothness(const TriangleMesh& mesh) {
  const SparseMatrix laplacian = surface_laplacian(mesh);
  const Eigen::VectorXd areas = vertex_areas(mesh) / vertex_areas(mesh).mean();
  return laplacian + SparseMatrix(laplacian * areas.cwiseInverse().asDiagonal() * laplacian);
}

}  // namespace

Transfer transferred_weights(const TriangleMesh& mesh, const Rig& reference, const PerJoint<JointId>& joint_of,
                             const TransferOptions& options) {
  Matches matches = closest(mesh, reference, joint_of, options);
  accept_pieces_without_match(mesh, matches.is_close);
  Transfer out;
  for (const bool close : matches.is_close) ++(close ? out.taken : out.inpainted);
  if (out.inpainted == 0) {
    out.rows = std::move(matches.rows);
    return out;
  }
  constexpr double kHold = 1e8;  // known vertices: a thousandth of a millionth off at most
  SparseMatrix system = smoothness(mesh);
  Eigen::VectorXd hold = Eigen::VectorXd::Zero(system.rows());
  for (Eigen::Index v = 0; v < hold.size(); ++v) {
    if (matches.is_close[static_cast<std::size_t>(v)]) hold[v] = kHold;
    system.coeffRef(v, v) += hold[v] + 1e-9;
  }
  const Eigen::SimplicialLDLT<SparseMatrix> solver(system);
  out.rows = solved_for_joints(matches.rows, hold, solver);
  for (VertexId v : mesh.positions.ids())
    if (matches.is_close[index(v)]) out.rows[v] = std::move(matches.rows[v]);
  return out;
}

}  // namespace osteon::skin
