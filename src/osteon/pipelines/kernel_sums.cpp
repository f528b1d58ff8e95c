// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/kernel_sums.h"

#include "osteon/base/every_cpu.h"

namespace osteon::pipelines {

OSTEON_EVERY_CPU KernelSums kernel_sums(std::span<const KernelSources> all, const KernelPlace& at, float h2) {
  float sum_k[kLanes] = {}, sum_x[kLanes] = {}, sum_y[kLanes] = {}, sum_z[kLanes] = {};
  for (const KernelSources& sources : all) {
    const float* __restrict x = sources.x, * __restrict y = sources.y, * __restrict z = sources.z, * __restrict weight = sources.weight;
    // Behind the last source weights count as 0, which adds nothing: all lanes run to the end together.
    for (std::size_t i = 0; i < sources.count; i += kLanes) {
      const std::size_t left = sources.count - i;
      for (std::size_t l = 0; l < kLanes; ++l) {
        const float dx = x[i + l] - at.x, dy = y[i + l] - at.y, dz = z[i + l] - at.z;
        const float inside = h2 - ((dx * dx + dy * dy) + dz * dz);
        const float known = weight[i + l], counted = l < left ? known : 0.0f;
        const float k = counted * (inside > 0.0f ? inside : 0.0f);
        sum_k[l] += k;
        sum_x[l] += k * dx;
        sum_y[l] += k * dy;
        sum_z[l] += k * dz;
      }
    }
  }
  for (std::size_t half = kLanes / 2; half > 0; half /= 2)
    for (std::size_t l = 0; l < half; ++l) {
      sum_k[l] += sum_k[l + half];
      sum_x[l] += sum_x[l + half];
      sum_y[l] += sum_y[l + half];
      sum_z[l] += sum_z[l + half];
    }
  return {sum_k[0], sum_x[0], sum_y[0], sum_z[0]};
}

}  // namespace osteon::pipelines
