// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/point_grid.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace osteon::pipelines {
namespace {

// Cell coordinates packed into 21 bits each, z lowest, so that cells which follow one another along z have consecutive keys.
constexpr std::int64_t kBias = 1 << 20;
constexpr std::uint64_t kStepX = std::uint64_t{1} << 42, kStepY = std::uint64_t{1} << 21;

std::uint64_t cell_key(const Vec3f& p, float cell) {
  const auto part = [&](int axis) {
    const std::int64_t c = static_cast<std::int64_t>(std::floor(p[axis] / cell)) + kBias;
    assert(c > 0 && c < 2 * kBias - 1);
    return static_cast<std::uint64_t>(c);
  };
  return part(0) * kStepX + part(1) * kStepY + part(2);
}

}  // namespace

PointGrid::PointGrid(std::span<const Vec3f> points, std::span<const float> weights, float cell) : order_(points.size()) {
  assert(points.size() == weights.size());
  std::vector<std::uint64_t> key_of(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) key_of[i] = cell_key(points[i], cell);
  std::iota(order_.begin(), order_.end(), 0u);
  std::sort(order_.begin(), order_.end(),
            [&](std::uint32_t a, std::uint32_t b) { return std::pair(key_of[a], a) < std::pair(key_of[b], b); });
  for (std::uint32_t place = 0; place < order_.size(); ++place) {
    const std::uint32_t i = order_[place];
    if (keys_.empty() || keys_.back() != key_of[i]) {
      keys_.push_back(key_of[i]);
      starts_.push_back(place);
    }
    positions_.push_back(points[i]);
    weights_.push_back(weights[i]);
  }
  starts_.push_back(static_cast<std::uint32_t>(order_.size()));
}

std::vector<PointGrid::Run> PointGrid::around(std::size_t cell) const {
  std::vector<Run> runs;
  for (int dx = -1; dx <= 1; ++dx)
    for (int dy = -1; dy <= 1; ++dy) {
      const std::uint64_t middle = keys_[cell] + static_cast<std::uint64_t>(dx) * kStepX + static_cast<std::uint64_t>(dy) * kStepY;
      const auto first = std::lower_bound(keys_.begin(), keys_.end(), middle - 1) - keys_.begin();
      const auto last = std::upper_bound(keys_.begin() + first, keys_.end(), middle + 1) - keys_.begin();
      const Run run{starts_[static_cast<std::size_t>(first)], starts_[static_cast<std::size_t>(last)]};
      if (run.begin < run.end) runs.push_back(run);
    }
  return runs;
}

}  // namespace osteon::pipelines
