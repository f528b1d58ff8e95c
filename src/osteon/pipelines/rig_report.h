// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "osteon/mesh/triangle_mesh.h"
#include "osteon/rig/skeleton.h"

namespace osteon::pipelines {

struct StageTime {
  std::string stage;
  double seconds;
};

// How far a rig can be trusted, and how it came about. Lengths: longest side of the character = 1.
struct RigReport {
  std::size_t vertices = 0, working_vertices = 0, joints = 0;
  char up = 'y';  // the axis of the mesh that was taken for its up axis, y or z
  // 0..1: the share of the joints that can be expected to be right, 0 where none was found: `character` times the mean of
  // `joint_confidence` (pipelines/confidence.h). Where the skeleton is given: the coverage.
  float confidence = 0.0f;
  std::vector<float> joint_confidence;   // (J) probability that an artist would have put a joint there; empty: skeleton given
  std::optional<float> character;        // probability that the shape is a character; none: skeleton given
  std::optional<float> explained;        // share of all attention that points at a joint; none: skeleton given
  std::optional<float> bone_confidence;  // geometric mean of the probabilities of the chosen bones; none: skeleton given
  float coverage = 0.0f;                 // share of the vertices with a bone within 0.2 by way of the body
  std::optional<float> symmetry_error;   // mean distance from each joint's mirror image to the nearest joint; none: no symmetry plane
  std::optional<float> bandwidth;        // of the mean shift, as used; none: skeleton given
  std::vector<StageTime> stages;         // in the order in which they ran
  std::vector<std::string> warnings;     // what the user should look at
  std::vector<std::string> repairs;      // what was wrong with the mesh and was mended in the working copy (never in the asset)
};

// Mean distance from the mirror image of each point to the nearest point. Pre: there are points.
float mirror_error(const std::vector<Vec3f>& points, const Plane& plane);

// Share of the rows with an entry <= reach, 0..1.
float covered_share(const Matrix& distances, float reach);

}  // namespace osteon::pipelines
