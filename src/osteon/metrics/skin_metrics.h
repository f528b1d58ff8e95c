// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "osteon/rig/pose.h"
#include "osteon/rig/rig.h"

namespace osteon::metrics {

// How well skin weights meet the reference's, for the same mesh and skeleton.
struct SkinScores {
  double precision, recall;  // of the influences (vertex, joint) with a weight above 1e-4
  double l1;                 // mean over the vertices of sum_j |w - w'|, 0..2
  double mean_distance;      // between the vertices that the two weights deform, over all vertices and poses; in the mesh's unit
  double max_distance;       // the largest of a pose, averaged over the poses
};

struct SkinMetricOptions {
  int poses = 10;
  float spread = 0.5235988f;  // standard deviation of a joint's angle, radians: 30 degrees
  float limit = 1.5707964f;   // angles are cut at +- this: 90 degrees
  std::uint64_t seed = 1;
};

// RigNet (sec. 5.3, table 2); its paper leaves the distribution of the poses open: see random_poses. By convention the rig is scaled so
// that its longest side is 1. Pre: validate(reference) holds, and validate(predicted, ...) for the same vertices and joints.
SkinScores compare_weights(const Rig& reference, const SkinWeights& predicted, const SkinMetricOptions& options = {});

// Every joint but the root turned about a uniformly random axis by a normal angle, cut at the limit.
std::vector<Pose> random_poses(const Skeleton& skeleton, const SkinMetricOptions& options = {});

}  // namespace osteon::metrics
