// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "osteon/infer/neuroskinning.h"
#include "osteon/infer/rignet.h"
#include "osteon/skin/bind.h"

namespace osteon::pipelines {

struct SkinCharacterOptions {
  skin::BindOptions bind = {};             // of the geometric methods; smoothing, pruning, influences, islands and locked joints of all
  const infer::RignetModels* rignet = {};  // the networks bind, and `bind.method` is not read; may be null
  const infer::NeuroskinningModel* neuroskinning = {};  // the same; with `rignet`, both as `rig` does it, by the NeuroSkinning in there
  bool mirror = false;                                  // make the two halves of a symmetric character equal, bit by bit
};

// Skin weights for a given skeleton, which is not touched: by geometry, by RigNet's networks or by NeuroSkinning's. What is not the
// character (geometry/surroundings.h) is left out and follows the root, but for Method::transfer, and a note counts it.
// Throws Error where the mesh cannot be bound, and for `mirror` where mesh or skeleton are not symmetric.
// Pre: validate(mesh) and validate(skeleton) hold, in one space.
skin::Binding skin_character(const TriangleMesh& mesh, const Skeleton& skeleton, const SkinCharacterOptions& options = {});

}  // namespace osteon::pipelines
