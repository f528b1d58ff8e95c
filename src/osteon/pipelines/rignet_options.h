// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include "osteon/geometry/bind_features.h"
#include "osteon/geometry/working_mesh.h"
#include "osteon/pipelines/body_frame.h"
#include "osteon/pipelines/joint_extraction.h"
#include "osteon/pipelines/skeleton_tree.h"
#include "osteon/pipelines/skin_prediction.h"
#include "osteon/rig/skeleton.h"

namespace osteon::pipelines {

enum class Symmetry { automatic, off };
enum class Fingers { automatic, off };  // automatic: where hands have them (hands.h), at `detail` 0.4 and more

// Parts of the method that can be left out, to see what each is good for (docs/results.md).
struct Ablation {
  bool attention = true;             // false: every vertex's vote counts alike
  bool views = true;                 // false: the network sees the character once, as it is
  bool edge_loops = true;            // false: joints stay where the votes gather
  bool bone_network = true;          // false: the nearer two joints are, the likelier a bone joins them
  bool geodesic = true;              // false: a bone is as far from a vertex as in a straight line
  float neuroskinning = 0.5f;        // its share in the weights, beside the binding network's; 0: that one alone
  int bones = geometry::kBindBones;  // a vertex chooses from so many at most, 1..kBindBones
};

struct RignetOptions {
  std::optional<float> bandwidth = {};     // of the mean shift, kFinestBandwidth..kCoarsestBandwidth; else by `detail`
  float detail = 0.5f;                     // 0 (few joints) .. 1 (many)
  std::optional<std::size_t> joints = {};  // about this many: the bandwidth is searched, and the two above are not read
  Symmetry symmetry = Symmetry::automatic;
  Fingers fingers = Fingers::automatic;
  Up up = Up::automatic;
  std::optional<Skeleton> skeleton = {};  // use this one, in the mesh's world coordinates, and only skin it
  geometry::WorkingMeshOptions working_mesh = {};
  JointExtractionOptions extraction = {};  // its bandwidth and number of joints are not read
  TreeOptions tree = {};
  SkinPredictionOptions skin = {};  // with the number of influences
  Ablation ablation = {};
};

// Throws Error that names the first option out of range, or what is wrong with the skeleton.
void validate(const RignetOptions& options);

}  // namespace osteon::pipelines
