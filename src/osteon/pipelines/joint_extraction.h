// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "osteon/geometry/voxel_grid.h"
#include "osteon/pipelines/joint_set.h"

namespace osteon::pipelines {

// The level of detail of the paper: the bandwidth may be anything in this range; in the middle is the one that gives the best skeletons of
// the validation characters.
constexpr float kFinestBandwidth = 0.01f, kDefaultBandwidth = 0.024f, kCoarsestBandwidth = 0.1f;

// Detail 0 is the coarsest bandwidth, 0.5 the default, 1 the finest, geometric in between. Pre: 0 <= detail <= 1.
float bandwidth_of_detail(float detail);

// Where the networks see joints: every vertex of the working mesh, displaced, with its attention.
struct JointCandidates {
  std::vector<Vec3f> positions;  // (V) normalised frame
  std::vector<float> attention;  // (V) 0..1
};

struct JointExtractionOptions {
  float bandwidth = kDefaultBandwidth;
  float step = 0.3f;              // of the mean shift
  float rest = 4e-5f;             // of the mean shift: ten more rounds would not take a vote as far as its tolerance
  float min_attention = 1e-3f;    // candidates below are ignored
  float expected_joints = 20.0f;  // about how many there are: where there are few, each gathers more
  float min_share =
      0.016f;  // one of 20 joints gathers at least this share of all attention within the default bandwidth (of J: times
               // the root of 20/J); less within a finer one (by the power of 2.5) and more within a coarser one (in proportion)
  float spread_share = 0.02f;    // of a joint that is found only with twice the bandwidth, among the votes that no other joint explains
  float one_sided_share = 0.1f;  // of a mirror pair, a side where there is no body is dropped when it gathers less than this share of the
                                 // other side's attention
};

struct JointExtraction {
  JointSet joints;
  float bandwidth = 0.0f;   // as used
  float explained = 0.0f;   // share of the attention that lies within one bandwidth of a joint after the mean shift, 0..1
  bool inside_used = true;  // false: hardly any candidate is inside the volume (an open sheet), so that test was left out
};

// Candidates -> joints (RigNet, sec. 4.1; facts 5.6): those inside the volume with attention, mirrored by `symmetry`; mean shift; a density
// that counts attention; pruning of thin modes; non-maximum suppression within one bandwidth. Where we differ from the authors' code:
// - Density is a share of all attention, so the threshold does not depend on the number of vertices (theirs does).
// - Both sides vote for a mirror pair; theirs throws the predictions of one side away. A pair of which one side has neither attention
//   nor body becomes one joint (a sword in one hand). Joints within half a bandwidth of the plane are put on it (theirs: 0.02).
// - When fewer than two modes pass the threshold, the two densest are taken.
// Empty when no candidate is left. The order of the joints is that of falling density.
JointExtraction extract_joints(const JointCandidates& candidates, const geometry::VoxelGrid& voxels, const std::optional<Plane>& symmetry,
                               const JointExtractionOptions& options = {});

// The same with the bandwidth in the whole range whose number of joints is nearest to `count` (ties: nearest to the default bandwidth).
JointExtraction extract_joint_count(const JointCandidates& candidates, const geometry::VoxelGrid& voxels,
                                    const std::optional<Plane>& symmetry, std::size_t count, const JointExtractionOptions& options = {});

}  // namespace osteon::pipelines
