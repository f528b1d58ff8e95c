// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>

// The inner loop of the mean shift, compiled for several instruction sets and chosen at start-up.
namespace osteon::pipelines {

// Sums are kept in so many parts, whatever the width of the processor's vectors, so that they are the same numbers on each.
constexpr std::size_t kLanes = 16;

struct KernelLanes {
  std::array<float, kLanes> k{}, x{}, y{}, z{};  // sum k; sum k (x_i - x), ...
};

struct KernelSources {
  const float *x, *y, *z, *weight;
  std::size_t count;
};

struct KernelPlace {
  float x, y, z;
};

// Adds what the sources weigh at the place: k_i = weight_i max(0, h2 - |x_i - x|^2). Source i goes into lane i modulo kLanes.
void add_kernel(const KernelSources& sources, const KernelPlace& at, float h2, KernelLanes& lanes);

}  // namespace osteon::pipelines
