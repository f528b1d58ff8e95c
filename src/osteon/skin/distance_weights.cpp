// SPDX-License-Identifier: Apache-2.0
#include "osteon/skin/distance_weights.h"

#include <cassert>
#include <cmath>

#include "osteon/base/parallel.h"

namespace osteon::skin {
namespace {

constexpr std::size_t kRowsPerTask = 256;

}  // namespace

Matrix distance_weights(const Matrix& distances, std::span<const Bone> bones, std::size_t joints, const DistanceWeightsOptions& options) {
  assert(static_cast<std::size_t>(distances.cols()) == bones.size() && !bones.empty() && options.margin > 0.0f);
  Matrix weights = Matrix::Zero(distances.rows(), static_cast<Eigen::Index>(joints));
  parallel_for(static_cast<std::size_t>(distances.rows()), kRowsPerTask, [&](std::size_t begin, std::size_t end) {
    for (auto v = static_cast<Eigen::Index>(begin); v < static_cast<Eigen::Index>(end); ++v) {
      const float nearest = distances.row(v).minCoeff() + options.margin;  // relative to it nothing overflows
      for (std::size_t b = 0; b < bones.size(); ++b) {
        float& weight = weights(v, static_cast<Eigen::Index>(index(bones[b].start)));
        weight = std::max(weight, std::pow(nearest / (distances(v, static_cast<Eigen::Index>(b)) + options.margin), options.falloff));
      }
      weights.row(v) /= weights.row(v).sum();
    }
  });
  return weights;
}

}  // namespace osteon::skin
