// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

// The pairs of points of a mean shift step (see mean_shift.h), for a range of targets or sources; in the calling thread.
namespace osteon::train {

// N points, coordinate by coordinate.
struct PointColumns {
  const float *x, *y, *z;
  std::int64_t count;
};

// For targets j in first .. last-1: weight[j] = sum_i k_ij, sum_x[j] = sum_i k_ij x_i, ... Arrays of length N.
struct KernelSums {
  float *weight, *sum_x, *sum_y, *sum_z;
};
void kernel_sums(const PointColumns& points, const float* attention, float squared_bandwidth, std::int64_t first, std::int64_t last,
                 const KernelSums& out);

// How a loss depends on the kernel: dL/dk_ij = w_j . x_i - offset_j. By target; of length N.
struct TargetGradient {
  const float *w_x, *w_y, *w_z, *offset;
};

// For j in first .. last-1: what j gets as target (d_x, d_y, d_z) and as source (added to them; d_attention), and its share of the
// derivative by the squared bandwidth.
struct PointGradients {
  float *d_x, *d_y, *d_z, *d_attention, *d_squared_bandwidth;
};
void kernel_gradients(const PointColumns& points, const float* attention, float squared_bandwidth, const TargetGradient& by,
                      std::int64_t first, std::int64_t last, const PointGradients& out);

}  // namespace osteon::train
