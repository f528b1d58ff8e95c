// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "osteon/infer/rignet.h"
#include "osteon/pipelines/body.h"
#include "osteon/rig/skeleton.h"

namespace osteon::pipelines {

// The skeleton's bones in the frame of the networks.
std::vector<Bone> normalised_bones(const Skeleton& skeleton, const geometry::Normalization& normalization);

// Whether many joints have hardly a vertex of the working mesh that is nearer to their bones than to all others, and the mesh can be finer:
// fingers. `bones`: normalised.
bool is_too_coarse(const std::vector<Bone>& bones, std::size_t joints, const Body& body, const geometry::WorkingMeshOptions& options);

// From each vertex of the working mesh to each bone, (V,B), by way of the body.
Matrix distances_to(const std::vector<Bone>& bones, const Body& body, const Ablation& ablation);

struct NetworkWeights {
  Matrix rows;      // (V,J) on the working mesh, for skin_prediction.h to finish
  bool are_of_two;  // two networks were heard
};

// By the binding network (nets/binding.h), or SkinNet where the models are the paper's (sec. 5); beside NeuroSkinning where the models have
// it and the ablation leaves it a share. `bones` and `distances`: of the two functions above.
NetworkWeights network_weights(const Skeleton& skeleton, const std::vector<Bone>& bones, const Matrix& distances, const Body& body,
                               const infer::RignetModels& models, const Ablation& ablation, Stages& stages,
                               std::vector<std::string>& warnings);

}  // namespace osteon::pipelines
