// SPDX-License-Identifier: Apache-2.0
#include "osteon/train/mean_shift_loops.h"

#include <algorithm>

#include "osteon/train/hot.h"

namespace osteon::train {

// The inner loops run over targets (or sources) side by side, so no sum is reordered and all of them vectorise.
OSTEON_HOT void kernel_sums(const PointColumns& points, const float* attention, float squared_bandwidth, std::int64_t first,
                            std::int64_t last, const KernelSums& out) {
  float *weight = out.weight, *sum_x = out.sum_x, *sum_y = out.sum_y, *sum_z = out.sum_z;
  for (float* values : {weight, sum_x, sum_y, sum_z}) std::fill(values + first, values + last, 0.0f);
  for (std::int64_t i = 0; i < points.count; ++i) {
    const float x = points.x[i], y = points.y[i], z = points.z[i], a = attention[i];
#pragma GCC ivdep
    for (std::int64_t j = first; j < last; ++j) {
      const float dx = x - points.x[j], dy = y - points.y[j], dz = z - points.z[j];
      const float inside = squared_bandwidth - (dx * dx + dy * dy + dz * dz);
      const float k = inside > 0.0f ? inside * a : 0.0f;
      weight[j] += k;
      sum_x[j] += k * x;
      sum_y[j] += k * y;
      sum_z[j] += k * z;
    }
  }
}

OSTEON_HOT void kernel_gradients(const PointColumns& points, const float* attention, float squared_bandwidth, const TargetGradient& by,
                                 std::int64_t first, std::int64_t last, const PointGradients& out) {
  float *d_x = out.d_x, *d_y = out.d_y, *d_z = out.d_z, *d_attention = out.d_attention, *d_bandwidth = out.d_squared_bandwidth;
  for (float* values : {d_x, d_y, d_z, d_attention, d_bandwidth}) std::fill(values + first, values + last, 0.0f);
  for (std::int64_t i = 0; i < points.count; ++i) {
    const float x = points.x[i], y = points.y[i], z = points.z[i], a = attention[i];
    const float w_x = by.w_x[i], w_y = by.w_y[i], w_z = by.w_z[i], offset = by.offset[i];
#pragma GCC ivdep
    for (std::int64_t j = first; j < last; ++j) {
      const float dx = x - points.x[j], dy = y - points.y[j], dz = z - points.z[j];
      const float inside = squared_bandwidth - (dx * dx + dy * dy + dz * dz);
      const float active = inside > 0.0f ? 1.0f : 0.0f;
      const float as_target = active * a * (by.w_x[j] * x + by.w_y[j] * y + by.w_z[j] * z - by.offset[j]);
      const float as_source = active * (w_x * points.x[j] + w_y * points.y[j] + w_z * points.z[j] - offset);
      const float k = active * inside * attention[j];
      const float pull = 2.0f * (as_target + attention[j] * as_source);
      d_x[j] += pull * dx + k * w_x;
      d_y[j] += pull * dy + k * w_y;
      d_z[j] += pull * dz + k * w_z;
      d_attention[j] += inside * as_source;
      d_bandwidth[j] += as_target;
    }
  }
}

}  // namespace osteon::train
