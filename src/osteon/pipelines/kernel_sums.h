// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>

// The inner loop of the mean shift, compiled for several instruction sets and chosen at start-up.
namespace osteon::pipelines {

// Sums are kept in so many parts, whatever the width of the processor's vectors, so that they are the same numbers on each.
constexpr std::size_t kLanes = 16;

// Weighted points: arrays of `count` numbers, each readable for kLanes more.
struct KernelSources {
  const float *x, *y, *z, *weight;
  std::size_t count;
};

struct KernelPlace {
  float x, y, z;
};

// sum k, and sum k (x_i - x), ...: relative to the place, so that far from the origin nothing is lost.
struct KernelSums {
  float k, x, y, z;
};

// What all sources weigh at the place: k_i = weight_i max(0, h2 - |x_i - x|^2).
KernelSums kernel_sums(std::span<const KernelSources> all, const KernelPlace& at, float h2);

}  // namespace osteon::pipelines
