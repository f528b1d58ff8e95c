// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/kernel_lanes.h"

#include "osteon/base/every_cpu.h"

namespace osteon::pipelines {

OSTEON_EVERY_CPU void add_kernel(const KernelSources& sources, const KernelPlace& at, float h2, KernelLanes& lanes) {
  const float* __restrict x = sources.x, * __restrict y = sources.y, * __restrict z = sources.z, * __restrict weight = sources.weight;
  float sum_k[kLanes], sum_x[kLanes], sum_y[kLanes], sum_z[kLanes];
  for (std::size_t l = 0; l < kLanes; ++l) {
    sum_k[l] = lanes.k[l];
    sum_x[l] = lanes.x[l];
    sum_y[l] = lanes.y[l];
    sum_z[l] = lanes.z[l];
  }
  const auto add = [&](std::size_t i, std::size_t l) {
    const float dx = x[i] - at.x, dy = y[i] - at.y, dz = z[i] - at.z;
    const float inside = h2 - ((dx * dx + dy * dy) + dz * dz);
    const float k = weight[i] * (inside > 0.0f ? inside : 0.0f);
    sum_k[l] += k;
    sum_x[l] += k * dx;
    sum_y[l] += k * dy;
    sum_z[l] += k * dz;
  };
  std::size_t i = 0;
  for (; i + kLanes <= sources.count; i += kLanes)
    for (std::size_t l = 0; l < kLanes; ++l) add(i + l, l);
  for (std::size_t l = 0; i < sources.count; ++i, ++l) add(i, l);
  for (std::size_t l = 0; l < kLanes; ++l) {
    lanes.k[l] = sum_k[l];
    lanes.x[l] = sum_x[l];
    lanes.y[l] = sum_y[l];
    lanes.z[l] = sum_z[l];
  }
}

}  // namespace osteon::pipelines
