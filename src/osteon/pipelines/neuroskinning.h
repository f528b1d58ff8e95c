// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "osteon/geometry/neighbourhoods.h"
#include "osteon/geometry/working_mesh.h"
#include "osteon/infer/neuroskinning.h"
#include "osteon/rig/skeleton.h"
#include "osteon/rig/skin_weights.h"
#include "osteon/skin/bone_choices.h"

namespace osteon::pipelines {

struct NeuroskinningOptions {
  float geometric_share = 0.33f;   // of geodesic voxel binding's own weights in the mean with the network's
  float prune_share = 0.15f;       // weights below this share of a vertex's largest go
  std::size_t max_influences = 4;  // the paper's kappa
  int smooth = 0;                  // rounds over the working mesh's one-ring
  bool rigid_islands = true;       // small parts that hang together with nothing else follow one joint (skin/islands.h)
  geometry::WorkingMeshOptions working_mesh = {};
  skin::BoneChoiceOptions choices = {};
};

struct NeuroskinningResult {
  SkinWeights weights;            // one row per vertex of the mesh that was given, in its order
  std::size_t rigid_islands = 0;  // how many were made so
  std::vector<std::string> warnings, repairs;
};

// What a network reads of a mesh and a skeleton, and whose its answers are.
struct NeuroskinningInputs {
  nets::MeshArrays graph;
  nets::NeuroArrays neuro;
  std::size_t joints = 0;                              // J, of the skeleton that was given
  std::vector<float> log_shares;                       // ours: (C) geodesic voxel binding's own share
  std::vector<JointId> joint_of_row;                   // ours: (C)
  std::vector<std::pair<JointId, std::size_t>> slots;  // the paper's: of the joints that have one to themselves
};

// The vertices that the graph units pool over, nearest first.
geometry::Neighbourhoods neuroskinning_neighbours(const TriangleMesh& mesh);

// For a normalised working mesh with its one-ring and those neighbours, and a skeleton in the same frame, upright. Where the joints' names
// have left at -x, the network is shown both turned by 180 degrees.
NeuroskinningInputs neuroskinning_inputs(const TriangleMesh& mesh, const geometry::Neighbourhoods& ring,
                                         const geometry::Neighbourhoods& near, const Skeleton& skeleton,
                                         const infer::NeuroskinningModel& model, const skin::BoneChoiceOptions& options = {});

// Weights that are not finished, (V,J); rows sum to 1.
Matrix neuroskinning_rows(const NeuroskinningInputs& inputs, const infer::NeuroskinningModel& model, float geometric_share,
                          std::vector<std::string>& warnings);

// Liu and others, NeuroSkinning, 2019: skin weights for a skeleton that is given. mesh -> its own frame, the left side by the joints' names
// at +x -> working mesh -> joints onto the slots of the super skeleton -> network -> weights on the mesh that was given. Joints at one
// place count as one, whose weights go to the one whose bone is nearest. The same for any order of vertices and any number of threads.
// Throws Error for a mesh without surface. Pre: validate(mesh) and validate(skeleton) hold, in one space.
NeuroskinningResult neuroskinning_weights(const TriangleMesh& mesh, const Skeleton& skeleton, const infer::NeuroskinningModel& model,
                                          const NeuroskinningOptions& options = {});

}  // namespace osteon::pipelines
