// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "osteon/base/types.h"
#include "osteon/pipelines/kernel_sums.h"

namespace osteon::pipelines {

// Weighted points sorted into cubic cells, so that everything within one cell size of a point is found in nine columns of three cells, each
// a run of consecutive points.
// The order within a cell is that of the input: sums over a run do not depend on anything else.
class PointGrid {
 public:
  // Pre: cell > 0; points finite, |coordinate| / cell < 2^20; as many weights as points.
  static constexpr std::size_t kColumns = 9, kPadding = kLanes;

  PointGrid(std::span<const Vec3f> points, std::span<const float> weights, float cell);

  struct Run {
    std::uint32_t begin, end;
  };
  std::size_t cells() const { return keys_.size(); }  // cells that hold a point, in a fixed order
  Run points_of(std::size_t cell) const { return {starts_[cell], starts_[cell + 1]}; }
  // Cells that follow one another along z, that of z - 1 first.
  struct Column {
    std::size_t number;                   // 3 (dx + 1) + dy + 1, with dx and dy cells from the middle
    std::array<std::uint32_t, 4> starts;  // where the three begin, and the end of the last
  };
  std::vector<Column> around(std::size_t cell) const;  // the cell and its 26 neighbours; columns without points are left out
  // Squared distances from a point to the cells below its own (0), to its own (1) and to those above (2) along each axis; cell size 1.
  using Gaps = std::array<std::array<float, 3>, 3>;
  Gaps gaps(const Vec3f& p) const;
  // The points of a column that can be within one cell size of a point in the middle cell: cells out of reach are left out.
  static Run within_reach(const Column& column, const Gaps& gaps);

  // By sorted place, 0..points-1:
  std::uint32_t original(std::size_t place) const { return order_[place]; }  // index in the constructor's spans
  Vec3f position(std::size_t place) const { return {x_[place], y_[place], z_[place]}; }
  KernelSources sources(const Run& run) const {
    return {&x_[run.begin], &y_[run.begin], &z_[run.begin], &weights_[run.begin], run.end - run.begin};
  }

 private:
  float cell_;
  std::vector<std::uint64_t> keys_;                           // of the non-empty cells, ascending
  std::vector<std::uint32_t> starts_;                         // first place of each cell, then the number of points
  std::vector<std::array<std::uint32_t, kColumns>> columns_;  // of each cell: the first cell of each column around it, or the one behind
  std::vector<std::uint32_t> order_;
  std::vector<float> x_, y_, z_, weights_;
};

}  // namespace osteon::pipelines
