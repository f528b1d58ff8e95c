// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "osteon/base/random.h"
#include "osteon/base/types.h"
#include "osteon/dataset/articulate.h"
#include "osteon/geometry/edge_flips.h"

namespace osteon::dataset {

struct AugmentOptions {
  float mirror = 0.5f;         // probability of x -> -x
  float half_turn = 0.5f;      // probability of turning by 180 degrees about y: which way characters face is nobody's rule
  float quarter_turn = 0.05f;  // probability of turning by 90 degrees
  float yaw = 0.2f;            // largest small turn about y, radians
  float tilt = 0.07f;          // largest turns about x and z
  float stretch = 0.12f;       // each axis is scaled by exp(u), |u| <= stretch
  ArticulateOptions articulate = {};
  float fold = 0.5f;                 // probability of a coarser rig: fewer joints, down to ...
  float least_fold = 0.25f;          // ... this share of them
  float misplaced = 0.5f;            // tree only: probability of joints that are not where they belong, by ...
  float misplacement = 0.015f;       // ... up to about this, in parts of the longest side
  float joint_count_blur = 0.15f;    // standard deviation of the logarithm of the number of joints that the voting network is told
  float reduce = 0.7f;               // probability of fewer vertices, where no weights are learned ...
  std::size_t least_vertices = 500;  // ... from here up to as many as there are
  float nameless = 0.25f;            // probability that joints' names are not read, where they would be
  float drop = 0.0f;                 // probability of fewer accessories ...
  float dropped = 0.5f;              // ... each then goes with this one
  float flip = 0.0f;                 // probability of other triangles on the same surface
  geometry::EdgeFlipOptions flips = {};

  // The whole character stays as it stands.
  void place_nothing() { mirror = half_turn = quarter_turn = yaw = tilt = stretch = 0.0f; }

  static AugmentOptions none() {
    return {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, {.probability = 0.0f}, 0.0f, 1.0f, 0.0f, 0.0f, 0.0f, 0.0f, 500, 0.0f};
  }
};

// An affine map of a character: its labels stay true.
struct Placement {
  Eigen::Matrix3f linear = Eigen::Matrix3f::Identity();
  Vec3f offset = Vec3f::Zero();
  float length_scale = 1.0f;  // mean change of lengths: cube root of |determinant|

  Vec3f apply(const Vec3f& p) const { return linear * p + offset; }
};

// A random map after which the positions are normalised again: longest side 1, feet on y = 0, centred on x and z. Pre: not empty.
Placement random_placement(std::span<const Vec3f> positions, const AugmentOptions& options, Random& random);

}  // namespace osteon::dataset
