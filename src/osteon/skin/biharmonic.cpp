// SPDX-License-Identifier: Apache-2.0
#include "osteon/skin/biharmonic.h"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "osteon/skin/joint_solves.h"
#include "osteon/skin/surface_laplacian.h"

namespace osteon::skin {
namespace {

using geometry::SolidLattice;

constexpr double kHold = 1e4;    // how hard nodes of bones are held
constexpr double kDrift = 1e-6;  // and all others, to their nearest bone: pieces without any bone have a solution too

SparseMatrix lattice_laplacian(const geometry::BodyLattice& body) {
  const auto nodes = static_cast<std::uint32_t>(body.solid().nodes());
  std::vector<Eigen::Triplet<double>> entries;
  for (std::uint32_t n = 0; n < nodes; ++n)
    for (std::size_t k = 0; k < geometry::lattice_steps().size(); ++k) {
      if (!(body.solid().steps[n] >> k & 1u) || geometry::lattice_steps()[k].abs().sum() != 1) continue;
      entries.emplace_back(static_cast<int>(n), static_cast<int>(body.step(n, k)), -1.0);
      entries.emplace_back(static_cast<int>(n), static_cast<int>(n), 1.0);
    }
  SparseMatrix out(nodes, nodes);
  out.setFromTriplets(entries.begin(), entries.end());
  return out;
}

std::uint32_t nearest_bone(const Vec3f& p, std::span<const Bone> bones, float& least) {
  std::uint32_t best = 0;
  least = std::numeric_limits<float>::infinity();
  for (std::uint32_t b = 0; b < bones.size(); ++b) {
    const auto& [a, e] = bones[b].segment;
    const Vec3f d = e - a;
    const float t = d.squaredNorm() > 0.0f ? std::clamp((p - a).dot(d) / d.squaredNorm(), 0.0f, 1.0f) : 0.0f;
    if (const float distance = (p - a - t * d).norm(); distance < least) {
      least = distance;
      best = b;
    }
  }
  return best;
}

bool is_near(JointId joint, std::span<const BoneDistance> near, std::span<const Bone> bones) {
  return std::ranges::any_of(near, [&](const BoneDistance& d) { return bones[d.bone].start == joint; });
}

}  // namespace

WeightRows biharmonic_weights(const geometry::BodyLattice& coarse, const BoneDistances& distances, std::span<const Bone> bones) {
  const std::size_t nodes = coarse.solid().nodes();
  WeightRows out(distances.size());
  for (VertexId v : out.ids()) out[v] = {{bones[distances.of(v).front().bone].start, 1.0f}};
  if (nodes == 0) return out;
  const SparseMatrix laplacian = lattice_laplacian(coarse);
  SparseMatrix system = laplacian * laplacian;
  Eigen::VectorXd hold(static_cast<Eigen::Index>(nodes));
  WeightRows sources(nodes);  // nodes in place of vertices
  for (std::size_t n = 0; n < nodes; ++n) {
    float distance = 0.0f;
    const std::uint32_t bone = nearest_bone(coarse.solid().positions[n], bones, distance);
    hold[static_cast<Eigen::Index>(n)] = distance <= 0.87f * coarse.solid().cell ? kHold : kDrift;
    sources[static_cast<VertexId>(n)] = {{bones[bone].start, 1.0f}};
    system.coeffRef(static_cast<Eigen::Index>(n), static_cast<Eigen::Index>(n)) += hold[static_cast<Eigen::Index>(n)];
  }
  const Eigen::SimplicialLDLT<SparseMatrix> solver(system);
  const WeightRows of_nodes = solved_for_joints(sources, hold, solver);
  for (VertexId v : out.ids()) {
    WeightRow row;
    for (const auto& [to, length] : coarse.links(coarse.node(v)))
      if (!coarse.is_vertex(to)) row.insert(row.end(), of_nodes[VertexId{to}].begin(), of_nodes[VertexId{to}].end());
    std::erase_if(row, [&](const Influence& i) { return !is_near(i.joint, distances.of(v), bones); });
    if (row.empty()) continue;
    merge(row);
    normalize(row);
    out[v] = std::move(row);
  }
  return out;
}

}  // namespace osteon::skin
