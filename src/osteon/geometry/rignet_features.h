// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "osteon/base/types.h"
#include "osteon/geometry/voxel_grid.h"

// The inputs of RigNet's connectivity and skinning networks that geometry gives (facts 6.1, 7.3), and the skinning targets (7.5).
namespace osteon::geometry {

constexpr int kPairFeatures = 8;  // joint i xyz, joint j xyz, Euclidean distance, fraction of the samples between them that is inside

// One row for each pair i < j of joints, in the order (0,1), (0,2), ..., (1,2), ...: (J(J-1)/2, 8). Everything in the normalised frame.
Matrix pair_features(std::span<const Vec3f> joints, const VoxelGrid& grid);

constexpr int kBoneFeatures = 8;  // start xyz, end xyz, proximity(D), leaf flag 0/1

using IndexMatrix = Eigen::Matrix<int, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// `distances` (V,B) with infinity for all bones but the nearest of those that start at one joint, `starts` (B): the weight of a joint goes
// to that bone alone (skin_targets), so the others would only take up room among the k. Of 60 characters from as many groups, the 5 nearest
// bones can carry 96.9 % of the weight and at least nine tenths of it at 93.1 % of the vertices; those of 5 different joints 99.2 and 97.9
// %. The reference takes the nearest bones of whatever joint.
Matrix one_bone_per_joint(const Matrix& distances, std::span<const int> starts);

// The k nearest bones of each vertex by `distances` (V,B), (V,k): nearest first, ties: the smaller index; -1 where fewer are at a finite
// distance.
IndexMatrix nearest_bones(const Matrix& distances, int k);

constexpr int kSkinBones = 5;  // that a vertex chooses from in the paper

struct SkinInputs {
  Matrix features;      // (V, 3 + 8k): position, then the bones of `nearest`, nearest first
  IndexMatrix nearest;  // (V,k) bone; -1 where fewer than k are at a finite distance: the features there repeat the nearest bone's
};

// Bounded stand-in for RigNet's 1 / (D + 1e-10), which reaches 1e10 for a vertex on a bone: 0.1 / (D + 0.02), so 5 on the bone, 1 at D =
// 0.08 (about the radius of a trunk), under 0.1 out of reach.
float proximity(float distance);
float distance_of_proximity(float proximity);  // the way back

// The k nearest bones of each vertex by `distances`, (V,B), from volumetric_geodesic_distance; ties: the smaller index. `leaf` (B) is 1 for
// the zero-length bones at leaf joints. Pre: positions and rows of `distances` are equally many; each row has a finite distance.
SkinInputs skin_inputs(std::span<const Vec3f> positions, std::span<const Segment> bones, std::span<const std::uint8_t> leaf,
                       const Matrix& distances, int k = kSkinBones);

struct SkinTargets {
  Matrix weights;              // (V,k), each row sums to 1, or is zero where `covered` is
  std::vector<float> covered;  // (V) the part of the vertex's weight that its k bones can carry, 0..1; train where it is near 1
};

// The weight of a joint goes to the nearest of the bones that start there, 0 to its others and to padding. `joint_weights` (V,J), rows sum
// to 1; `starts` (B) is the joint at which each bone starts. The reference leaves out rows with |covered - 1| >= 1e-8 and so loses about 7
// % of the vertices to rounding: 1e-4 is meant.
SkinTargets skin_targets(const Matrix& joint_weights, std::span<const int> starts, const IndexMatrix& nearest);

}  // namespace osteon::geometry
