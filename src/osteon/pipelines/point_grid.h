// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "osteon/base/types.h"

namespace osteon::pipelines {

// Weighted points sorted into cubic cells, so that everything within one cell size of a point is found in nine runs of consecutive points.
// The order within a cell is that of the input: sums over a run do not depend on anything else.
class PointGrid {
 public:
  // Pre: cell > 0; points finite, |coordinate| / cell < 2^20; as many weights as points.
  PointGrid(std::span<const Vec3f> points, std::span<const float> weights, float cell);

  struct Run {
    std::uint32_t begin, end;
  };
  std::size_t cells() const { return keys_.size(); }  // cells that hold a point, in a fixed order
  Run points_of(std::size_t cell) const { return {starts_[cell], starts_[cell + 1]}; }
  std::vector<Run> around(std::size_t cell) const;  // the cell and its 26 neighbours

  // By sorted place, 0..points-1:
  std::uint32_t original(std::size_t place) const { return order_[place]; }  // index in the constructor's spans
  Vec3f position(std::size_t place) const { return {x_[place], y_[place], z_[place]}; }
  // The points of a run coordinate by coordinate, for loops over many of them.
  struct Columns {
    const float *x, *y, *z, *weight;
    std::size_t count;
  };
  Columns columns(const Run& run) const {
    return {&x_[run.begin], &y_[run.begin], &z_[run.begin], &weights_[run.begin], run.end - run.begin};
  }

 private:
  std::vector<std::uint64_t> keys_;    // of the non-empty cells, ascending
  std::vector<std::uint32_t> starts_;  // first place of each cell, then the number of points
  std::vector<std::uint32_t> order_;
  std::vector<float> x_, y_, z_, weights_;
};

}  // namespace osteon::pipelines
