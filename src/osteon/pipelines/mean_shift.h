// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "osteon/base/types.h"

namespace osteon::pipelines {

// Whether every point also acts as its mirror image (-x, y, z) with the same weight. The images move as their points do and are
// never stored: half the work, and the result is symmetric to the last bit.
enum class Mirror { off, across_x };

struct MeanShiftOptions {
  float bandwidth = 0.0429f;  // h, in the unit of the points
  float step = 0.3f;          // share of the way to the local mean that a point goes in one iteration
  float tolerance = 1e-3f;    // stop when no point moves farther in one iteration
  float rest = 0.0f;          // a point that goes less far in one iteration stays there, while others still move; 0: none does
  int most_iterations = 100;
};

struct MeanShiftResult {
  std::vector<Vec3f> points;  // in the order of the input
  int iterations = 0;
  bool converged = false;  // false: stopped by most_iterations
};

// Blurring mean shift with the Epanechnikov kernel and weighted sources (Xu et al., RigNet, 2020, eq. 6): every point j moves towards
// sum_i k_ij x_i / sum_i k_ij, k_ij = weights_i * max(0, h^2 - |x_i - x_j|^2). A point of weight 0 far from all others stays.
// Step: the authors' 0.3, with which the networks are trained too (the paper's text has 1). Stopping rule: the paper's (largest
// single move); the authors' code tests the norm of all moves together, which depends on the number of points.
// Pre: bandwidth > 0; points finite, weights >= 0, equally many of both.
MeanShiftResult mean_shift(std::span<const Vec3f> points, std::span<const float> weights, Mirror mirror, const MeanShiftOptions& options);

// Per point the sum_i weights_i * max(0, 1 - |x_i - x_j|^2 / h^2), images included.
std::vector<float> kernel_density(std::span<const Vec3f> points, std::span<const float> weights, Mirror mirror, float bandwidth);

}  // namespace osteon::pipelines
