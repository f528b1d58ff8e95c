// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "osteon/geometry/neighbourhoods.h"
#include "osteon/geometry/rignet_features.h"
#include "osteon/geometry/working_mesh.h"
#include "osteon/rig/skeleton.h"
#include "osteon/rig/skin_weights.h"

namespace osteon::pipelines {

struct SkinPredictionOptions {
  float prune_share = 0.35f;       // weights below this share of a vertex's largest go
  std::size_t max_influences = 4;  // per vertex of the original
};

// What a network says about the nearest bones of each vertex -> weights of joints, (V,J): a bone's weight belongs to the joint where the
// bone starts; padding (-1) is ignored, so characters of fewer bones lose nothing (facts, trap R7). No "dup" joints (trap R14).
Matrix joint_weights(const Matrix& bone_weights, const geometry::IndexMatrix& nearest, std::span<const Bone> bones, std::size_t joints);

// Raw weights of joints on the working mesh (V,J) -> final ones on the original: smoothed once over the one-ring, small ones pruned, holes
// filled from the nearest vertex, carried back (facts 7.6). A mesh without any weight gets joint 0 throughout.
SkinWeights finish_weights(const Matrix& raw, const geometry::WorkingMesh& working, const geometry::Neighbourhoods& one_ring,
                           const SkinPredictionOptions& options = {});

}  // namespace osteon::pipelines
