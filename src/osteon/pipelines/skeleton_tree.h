// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "osteon/geometry/voxel_grid.h"
#include "osteon/geometry/working_mesh.h"
#include "osteon/pipelines/joint_names.h"
#include "osteon/pipelines/joint_set.h"
#include "osteon/rig/skeleton.h"

namespace osteon::pipelines {

// What is known about which joints belong together.
struct TreeEvidence {
  Matrix bone_probability;              // (J,J) symmetric, 0..1; the diagonal is not read
  std::vector<float> root_probability;  // (J) 0..1
  Matrix outside;                       // (J,J) symmetric: samples of the segment between two joints that lie outside the volume
};

// Samples at every 0.01 outside the volume, for all pairs (facts 6.1).
Matrix samples_outside(std::span<const Vec3f> joints, const geometry::VoxelGrid& voxels);

struct TreeOptions {
  float outside_penalty = 0.5f;  // added to a bone's cost for each sample outside beyond the first
  float middle_discount = 0.5f;  // factor on the cost of a bone in the symmetry plane
};

struct JointTree {
  std::size_t root = 0;
  std::vector<std::optional<std::size_t>> parents;  // (J) empty for the root
  float likelihood = 1.0f;                          // geometric mean of the probabilities of the chosen bones, 0..1
};

// The cheapest spanning tree, cost of a bone -log p plus what it does outside the volume (RigNet, sec. 4.2; facts 6.4), among those that
// are their own mirror image. Such trees are exactly these: the joints on the plane form a tree of their own; mirror pairs hang on it, or
// on one another, both sides alike (with no joint on the plane one pair is joined across it); joints without a partner hang anywhere. So
// three runs of Prim's algorithm, each growing the last tree, find the optimum. Without symmetry the third is all: plain Prim.
// The root is the likeliest joint, of those on the plane if there are any.
// Differs from the authors' heuristic, which may leave joints out, forgets the surest bones (p = 1) and lets a bone outside the volume
// forget its probability (facts, traps R9 and R10). Pre: J >= 1, sizes agree.
JointTree connect(const JointSet& joints, const TreeEvidence& evidence, const TreeOptions& options = {});

// In the unit and frame that `normalization` undoes to: depth first from the root, in the order of the joint set; named (joint_names.h) and
// oriented along the bones, as one sees the character from its front, which is +z, or -z where `is_seen_from_behind`. `parts`: what
// each joint is of a hand, in the order of the joint set; empty: nothing.
struct TreeSkeleton {
  Skeleton skeleton;
  PerJoint<std::size_t> from;  // skeleton joint -> index in the joint set
};
TreeSkeleton make_skeleton(const JointSet& joints, const JointTree& tree, const geometry::Normalization& normalization,
                           bool is_seen_from_behind = false, std::span<const std::optional<HandPart>> parts = {});

}  // namespace osteon::pipelines
