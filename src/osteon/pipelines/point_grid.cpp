// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/point_grid.h"

#include <algorithm>
#include <array>
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

// The lowest of the three cells in one of the nine columns around a cell: column 3 (dx + 1) + dy + 1.
std::uint64_t first_key(std::uint64_t cell, std::size_t column) {
  return cell + column / 3 * kStepX + column % 3 * kStepY - kStepX - kStepY - 1;
}

// The indices of the keys, ascending; equal keys in the order of their indices. By counting where the keys' coordinates span a small box.
std::vector<std::uint32_t> ascending(const std::vector<std::uint64_t>& keys) {
  std::vector<std::uint32_t> order(keys.size());
  std::array<std::uint64_t, 3> low{~std::uint64_t{0}, ~std::uint64_t{0}, ~std::uint64_t{0}}, high{0, 0, 0};
  const auto parts = [](std::uint64_t key) { return std::array{key / kStepX, key / kStepY % kStepY, key % kStepY}; };
  for (const std::uint64_t key : keys)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], parts(key)[axis]);
      high[axis] = std::max(high[axis], parts(key)[axis]);
    }
  std::array<std::uint64_t, 3> size{};
  for (std::size_t axis = 0; axis < 3; ++axis) size[axis] = high[axis] - low[axis] + 1;
  constexpr std::uint64_t kMostCells = 1 << 18;
  if (keys.empty() || size[0] > kMostCells || size[1] > kMostCells || size[2] > kMostCells || size[0] * size[1] > kMostCells ||
      size[0] * size[1] * size[2] > kMostCells) {
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return keys[a] < keys[b]; });
    return order;
  }
  const auto cell = [&](std::uint64_t key) {
    const auto [x, y, z] = parts(key);
    return ((x - low[0]) * size[1] + (y - low[1])) * size[2] + (z - low[2]);
  };
  std::vector<std::uint32_t> next(size[0] * size[1] * size[2] + 1, 0);
  for (const std::uint64_t key : keys) ++next[cell(key) + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  for (std::uint32_t i = 0; i < keys.size(); ++i) order[next[cell(keys[i])]++] = i;
  return order;
}

}  // namespace

PointGrid::PointGrid(std::span<const Vec3f> points, std::span<const float> weights, float cell) : cell_(cell) {
  assert(points.size() == weights.size());
  std::vector<std::uint64_t> key_of(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) key_of[i] = cell_key(points[i], cell);
  order_ = ascending(key_of);
  for (std::vector<float>* column : {&x_, &y_, &z_, &weights_}) column->reserve(order_.size() + kPadding);
  for (std::uint32_t place = 0; place < order_.size(); ++place) {
    const std::uint32_t i = order_[place];
    if (keys_.empty() || keys_.back() != key_of[i]) {
      keys_.push_back(key_of[i]);
      starts_.push_back(place);
    }
    x_.push_back(points[i].x());
    y_.push_back(points[i].y());
    z_.push_back(points[i].z());
    weights_.push_back(weights[i]);
  }
  starts_.push_back(static_cast<std::uint32_t>(order_.size()));
  for (std::vector<float>* column : {&x_, &y_, &z_, &weights_}) column->resize(order_.size() + kPadding, 0.0f);

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
    const float below = p[axis] / cell_ - std::floor(p[axis] / cell_), above = 1.0f - below;
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
