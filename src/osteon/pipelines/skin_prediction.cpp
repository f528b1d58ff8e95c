// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/skin_prediction.h"

#include <cassert>

#include "osteon/skin/islands.h"
#include "osteon/skin/weight_cleanup.h"

namespace osteon::pipelines {

Matrix joint_weights(const Matrix& bone_weights, const geometry::IndexMatrix& nearest, std::span<const Bone> bones, std::size_t joints) {
  assert(bone_weights.rows() == nearest.rows() && bone_weights.cols() == nearest.cols());
  Matrix out = Matrix::Zero(bone_weights.rows(), static_cast<Eigen::Index>(joints));
  for (Eigen::Index v = 0; v < nearest.rows(); ++v)
    for (Eigen::Index k = 0; k < nearest.cols(); ++k)
      if (const int b = nearest(v, k); b >= 0)
        out(v, static_cast<Eigen::Index>(index(bones[static_cast<std::size_t>(b)].start))) += bone_weights(v, k);
  return out;
}

Matrix pooled(const Matrix& a, const Matrix& b, float share) {
  constexpr float kUnsure = 0.03f, kSharper = 1.2f;
  Matrix out = ((1.0f - share) * (a.array() + kUnsure).log() + share * (b.array() + kUnsure).log()).exp().matrix();
  out = (out.array() - kUnsure).cwiseMax(0.0f).pow(kSharper).matrix();
  for (auto row : out.rowwise())
    if (const float sum = row.sum(); sum > 0.0f) row /= sum;
  return out;
}

SkinWeights finish_weights(const Matrix& raw, const geometry::WorkingMesh& working, const geometry::Neighbourhoods& one_ring,
                           const Skeleton& skeleton, const SkinPredictionOptions& options) {
  const auto columns = static_cast<std::size_t>(raw.cols());
  Matrix weights = raw;
  skin::prune_rows(weights, 0.0f, columns);  // rows sum to 1 and are finite from here on
  for (int round = 0; round < options.smooth.value_or(1); ++round) weights = skin::smooth_rows(weights, one_ring);
  skin::prune_rows(weights, options.prune_share.value_or(0.35f), options.max_influences);
  skin::fill_empty_rows(weights, working.mesh.positions, one_ring);
  if (!(weights.maxCoeff() > 0.0f)) weights.col(0).setOnes();
  SkinWeights out = skin::weights_on_original(weights, geometry::carry_back(working), options.max_influences);
  out = skin::evened(out, working.clean, options.max_influences);
  if (options.rigid_islands) skin::make_islands_rigid(out, working.clean, skeleton);
  return out;
}

}  // namespace osteon::pipelines
