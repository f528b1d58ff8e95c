// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "osteon/geometry/neighbourhoods.h"
#include "osteon/geometry/rignet_features.h"
#include "osteon/geometry/working_mesh.h"
#include "osteon/rig/skeleton.h"
#include "osteon/rig/skin_weights.h"

namespace osteon::pipelines {

struct SkinPredictionOptions {
  std::optional<int> smooth = {};         // rounds over the working mesh's one-ring; else 1 (0 where two networks are heard)
  std::optional<float> prune_share = {};  // weights below this share of a vertex's largest go; else 0.35 (0.05 where two are heard)
  std::size_t max_influences = 4;         // per vertex of the original
  bool rigid_islands = true;              // small parts that hang together with nothing else follow one joint (skin/islands.h)
};

// What a network says about the nearest bones of each vertex -> weights of joints, (V,J): a bone's weight belongs to the joint where the
// bone starts; padding (-1) is ignored, so characters of fewer bones lose nothing (facts, trap R7). No "dup" joints (trap R14).
Matrix joint_weights(const Matrix& bone_weights, const geometry::IndexMatrix& nearest, std::span<const Bone> bones, std::size_t joints);

// What two say of the weights (V,J), rows sum to 1, as one: a logarithmic opinion pool (Genest, Zidek. Combining Probability Distributions.
// Statistical Science 1(1), 1986, section 3), `share` of it b's, in which nobody is sure of nothing: a joint that one of both rules out is
// nearly out, where a mean would leave it half. And a little sharper: L1 wants the median of what artists do, networks say the mean. Rows
// sum to 1, or are 0.
Matrix pooled(const Matrix& a, const Matrix& b, float share);

// Raw weights of joints on the working mesh (V,J) -> final ones on the original: smoothed over the one-ring, small ones pruned, holes
// filled from the nearest vertex, carried back (facts 7.6). A mesh without any weight gets joint 0 throughout. Islands that are made rigid
// are ours. `skeleton`: in the space of the mesh that was given.
SkinWeights finish_weights(const Matrix& raw, const geometry::WorkingMesh& working, const geometry::Neighbourhoods& one_ring,
                           const Skeleton& skeleton, const SkinPredictionOptions& options = {});

}  // namespace osteon::pipelines
