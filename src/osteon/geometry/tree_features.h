// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "osteon/base/types.h"
#include "osteon/geometry/voxel_grid.h"

// What geometry knows of joints as parts of one skeleton: the inputs of the network that finds the tree (nets/tree.h).
namespace osteon::geometry {

// The share of the way between each two joints that is inside the shape, 0..1: (J,J), symmetric, 1 on the diagonal.
Matrix inside_shares(std::span<const Vec3f> joints, const VoxelGrid& grid);

// What there is to know of a character's joints. Normalised frame.
struct JointSurroundings {
  std::span<const Vec3f> joints;    // J
  std::span<const Vec3f> images;    // J: each joint's mirror image
  std::span<const Vec3f> vertices;  // of the surface, spread evenly
  const Matrix& inside;             // (J,J), see inside_shares()
};

struct TreeFeatures {
  Matrix joints;  // (J,kTreeJointFeatures)
  Matrix pairs;   // (J*J,kTreePairFeatures), row i*J + j: of joint j as joint i sees it
};

// A joint: position, distance to its mirror image, distance to the nearest vertex, share of the vertices that are nearest to it (times
// J), mean way to these, distance to the nearest joint, mean distance to the joints, distance to the middle of the vertices, log(J); in
// the shortest spanning tree its degree, the share of the joints in the largest part that is left without it, and the steps to the farthest
// joint in parts of the most between any two; height over the middle.
constexpr int kTreeJointFeatures = 17;
// A pair: way from i to j, distance, the same in parts of i's and j's distance to their nearest joints (logarithms), share inside, length
// outside, 1 / (1 + rank) of j among i's nearest joints and of i among j's, 1 / (1 + the joints nearer to both than they are to each
// other), 1 / steps in the shortest spanning tree, whether that is one step, how near j is to i's mirror image, whether i = j.
constexpr int kTreePairFeatures = 15;

// Way outside counts five times in the spanning tree. O(J^3 + JV). Pre: there are joints and vertices; sizes agree.
TreeFeatures tree_features(const JointSurroundings& surroundings);

}  // namespace osteon::geometry
