// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/connectivity.h"

#include <algorithm>
#include <cmath>

#include "osteon/geometry/rignet_features.h"
#include "osteon/geometry/tree_features.h"

namespace osteon::pipelines {
namespace {

Matrix symmetric(const Matrix& of_pairs, std::size_t joints) {
  const auto n = static_cast<Eigen::Index>(joints);
  Matrix out = Matrix::Zero(n, n);
  Eigen::Index pair = 0;
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = i + 1; j < n; ++j) out(i, j) = out(j, i) = of_pairs(pair++, 0);
  return out;
}

// How likely bones are where nothing but their length counts.
Matrix nearness(const std::vector<Vec3f>& positions) {
  constexpr float kLength = 0.1f;  // the tree is the same for any
  const auto n = static_cast<Eigen::Index>(positions.size());
  Matrix out(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      out(i, j) = std::exp(-(positions[static_cast<std::size_t>(i)] - positions[static_cast<std::size_t>(j)]).norm() / kLength);
  return out;
}

// Who belongs together and who is the root, where it is known of each joint how likely the others are its parent.
TreeEvidence evidence_of_parents(const Matrix& parents, Matrix outside) {
  TreeEvidence out{(parents + parents.transpose()).cwiseMin(1.0f), {}, std::move(outside)};
  const float sum = std::max(parents.diagonal().sum(), 1e-6f);
  for (const float own : parents.diagonal()) out.root_probability.push_back(own / sum);
  return out;
}

Matrix parent_probabilities(std::span<const Vec3f> joints, const nets::JointArrays& arrays, const Plane& plane, const Body& body,
                            const infer::RignetModels& models) {
  std::vector<Vec3f> images;
  for (const Vec3f& p : joints) images.push_back(plane.mirror(p));
  const Matrix inside = geometry::inside_shares(joints, body.voxels);
  const geometry::TreeFeatures features = geometry::tree_features({joints, images, body.positions(), inside});
  nets::TreeArrays tree;
  tree.add({features.joints.data(), static_cast<std::size_t>(features.joints.size())},
           {features.pairs.data(), static_cast<std::size_t>(features.pairs.size())});
  return models.parent_probabilities(arrays, tree);
}

}  // namespace

TreeEvidence tree_evidence(const JointSet& joints, const Body& body, const infer::RignetModels& models, const Ablation& ablation) {
  const std::vector<Vec3f> positions = joints.normalised();
  const Plane plane = body.symmetry.value_or(Plane{Vec3f::UnitX(), 0.0f});
  std::vector<float> plane_distances;
  for (const Vec3f& p : positions) plane_distances.push_back(std::abs(plane.signed_distance(p)));
  const nets::JointArrays arrays = infer::single_skeleton(positions, plane_distances);
  if (models.finds_parents()) {
    TreeEvidence known =
        evidence_of_parents(parent_probabilities(positions, arrays, plane, body, models), samples_outside(positions, body.voxels));
    if (!ablation.bone_network) known.bone_probability = nearness(positions);
    return known;
  }
  const Matrix root = models.root_probabilities(body.graph, arrays);
  const auto bones = [&] {
    if (!ablation.bone_network) return nearness(positions);
    if (positions.size() == 1) return symmetric(Matrix(0, 1), 1);
    return symmetric(models.bone_probabilities(body.graph, arrays, geometry::pair_features(positions, body.voxels)), positions.size());
  };
  return {bones(), {root.data(), root.data() + root.size()}, samples_outside(positions, body.voxels)};
}

}  // namespace osteon::pipelines
