// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/point_grid.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <numeric>
#include <optional>

#include "osteon/base/parallel.h"

namespace osteon::pipelines {
namespace {

// Cell coordinates packed into 21 bits each, z lowest, so that cells which follow one another along z have consecutive keys.
constexpr std::int64_t kBias = 1 << 20;
constexpr std::size_t kPointsPerTask = 2048;
constexpr std::uint64_t kStepX = std::uint64_t{1} << 42, kStepY = std::uint64_t{1} << 21;

// std::floor, which is a call into the C library on processors without SSE4.1. Pre: |x| < 2^31.
float floor_of(float x) {
  const auto whole = static_cast<float>(static_cast<std::int32_t>(x));
  return whole > x ? whole - 1.0f : whole;
}

std::uint64_t cell_key(const Vec3f& p, float cell) {
  const auto part = [&](int axis) {
    const std::int64_t c = static_cast<std::int64_t>(floor_of(p[axis] / cell)) + kBias;
    assert(c > 0 && c < 2 * kBias - 1);
    return static_cast<std::uint64_t>(c);
  };
  return part(0) * kStepX + part(1) * kStepY + part(2);
}

// The lowest of the three cells in one of the nine columns around a cell: column 3 (dx + 1) + dy + 1.
std::uint64_t first_key(std::uint64_t cell, std::size_t column) {
  return cell + column / 3 * kStepX + column % 3 * kStepY - kStepX - kStepY - 1;
}

// Of the cells in one range of the keys, then of all.
struct Box {
  using Parts = std::array<std::uint64_t, 3>;
  Parts low{~std::uint64_t{0}, ~std::uint64_t{0}, ~std::uint64_t{0}}, high{0, 0, 0};

  static Parts parts(std::uint64_t key) { return {key / kStepX, key / kStepY % kStepY, key % kStepY}; }
  void extend(const Parts& at_least, const Parts& at_most) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], at_least[axis]);
      high[axis] = std::max(high[axis], at_most[axis]);
    }
  }
  std::uint64_t size(std::size_t axis) const { return high[axis] - low[axis] + 1; }
  // How many cells, if no more than that.
  std::optional<std::size_t> volume(std::uint64_t most) const {
    std::uint64_t cells = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (low[axis] > high[axis] || size(axis) > most) return std::nullopt;
      if ((cells *= size(axis)) > most) return std::nullopt;
    }
    return cells;
  }
  // Ascending with the keys.
  std::uint32_t number(std::uint64_t key) const {
    const auto [x, y, z] = parts(key);
    return static_cast<std::uint32_t>(((x - low[0]) * size(1) + (y - low[1])) * size(2) + (z - low[2]));
  }
};

Box box_of(std::span<const std::uint64_t> keys) {
  std::vector<Box> boxes((keys.size() + kPointsPerTask - 1) / kPointsPerTask);
  parallel_for(keys.size(), kPointsPerTask, [&](std::size_t begin, std::size_t end) {
    Box box;
    for (const std::uint64_t key : keys.subspan(begin, end - begin)) box.extend(Box::parts(key), Box::parts(key));
    boxes[begin / kPointsPerTask] = box;
  });
  Box all;
  for (const Box& box : boxes) all.extend(box.low, box.high);
  return all;
}

// The indices of the keys, ascending; equal keys in the order of their indices. By counting where the keys' coordinates span a small box.
std::vector<std::uint32_t> ascending(const std::vector<std::uint64_t>& keys) {
  constexpr std::uint64_t kMostCells = 1 << 18;
  std::vector<std::uint32_t> order(keys.size());
  const Box box = box_of(keys);
  const auto volume = box.volume(kMostCells);
  if (!volume) {
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return keys[a] < keys[b]; });
    return order;
  }
  std::vector<std::uint32_t> cell_of(keys.size()), next(*volume + 1, 0);
  parallel_for(keys.size(), kPointsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) cell_of[i] = box.number(keys[i]);
  });
  for (const std::uint32_t cell : cell_of) ++next[cell + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  for (std::uint32_t i = 0; i < keys.size(); ++i) order[next[cell_of[i]]++] = i;
  return order;
}

}  // namespace

PointGrid::PointGrid(std::span<const Vec3f> points, std::span<const float> weights, float cell) : cell_(cell) {
  assert(points.size() == weights.size());
  std::vector<std::uint64_t> key_of(points.size());
  parallel_for(points.size(), kPointsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) key_of[i] = cell_key(points[i], cell);
  });
  order_ = ascending(key_of);
  for (std::uint32_t place = 0; place < order_.size(); ++place)
    if (const std::uint64_t key = key_of[order_[place]]; keys_.empty() || keys_.back() != key) {
      keys_.push_back(key);
      starts_.push_back(place);
    }
  starts_.push_back(static_cast<std::uint32_t>(order_.size()));

  for (std::vector<float>* column : {&x_, &y_, &z_, &weights_}) column->resize(order_.size() + kPadding, 0.0f);
  parallel_for(order_.size(), kPointsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t place = begin; place < end; ++place) {
      const std::uint32_t i = order_[place];
      x_[place] = points[i].x();
      y_[place] = points[i].y();
      z_[place] = points[i].z();
      weights_[place] = weights[i];
    }
  });

  columns_.resize(keys_.size());
  for (std::size_t c = 0; c < kColumns; ++c)
    for (std::size_t i = 0, first = 0; i < keys_.size(); ++i) {  // as the cells' keys rise, so do those around them
      while (first < keys_.size() && keys_[first] < first_key(keys_[i], c)) ++first;
      columns_[i][c] = static_cast<std::uint32_t>(first);
    }
}

std::vector<PointGrid::Column> PointGrid::around(std::size_t cell) const {
  std::vector<Column> columns;
  for (std::size_t c = 0; c < kColumns; ++c) {
    const std::uint64_t lowest = first_key(keys_[cell], c);
    std::size_t next = columns_[cell][c];
    Column column{c, {}};
    for (std::size_t i = 0; i < column.starts.size(); ++i) {
      while (next < keys_.size() && keys_[next] < lowest + i) ++next;
      column.starts[i] = starts_[next];
    }
    if (column.starts.front() < column.starts.back()) columns.push_back(column);
  }
  return columns;
}

PointGrid::Gaps PointGrid::gaps(const Vec3f& p) const {
  Gaps out{};
  for (int axis = 0; axis < 3; ++axis) {
    const float below = p[axis] / cell_ - floor_of(p[axis] / cell_), above = 1.0f - below;
    out[static_cast<std::size_t>(axis)] = {below * below, 0.0f, above * above};
  }
  return out;
}

PointGrid::Run PointGrid::within_reach(const Column& column, const Gaps& gaps) {
  constexpr float kReach = 1.0f + 1e-4f;  // rounding must not leave out what is within reach
  const float across = gaps[0][column.number / 3] + gaps[1][column.number % 3];
  const auto& [below, here, above, end] = column.starts;
  if (across > kReach) return {here, here};
  return {across + gaps[2][0] <= kReach ? below : here, across + gaps[2][2] <= kReach ? end : above};
}

}  // namespace osteon::pipelines
