// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/mean_shift.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

#include "osteon/base/parallel.h"
#include "osteon/pipelines/kernel_sums.h"
#include "osteon/pipelines/point_grid.h"

namespace osteon::pipelines {
namespace {

constexpr std::size_t kCellsPerTask = 4;

KernelSums sums_at(const Vec3f& p, const PointGrid& grid, const std::vector<PointGrid::Column>& columns, float h2) {
  static_assert(PointGrid::kPadding >= kLanes);
  const PointGrid::Gaps gaps = grid.gaps(p);
  std::array<KernelSources, PointGrid::kColumns> near;
  std::size_t count = 0;
  for (const PointGrid::Column& column : columns) {
    const PointGrid::Run run = PointGrid::within_reach(column, gaps);
    if (run.begin < run.end) near[count++] = grid.sources(run);
  }
  return kernel_sums({near.data(), count}, {p.x(), p.y(), p.z()}, h2);
}

// The points and, behind them, their images.
struct Sources {
  std::vector<Vec3f> points;
  std::vector<float> weights;
  std::size_t own;  // the rest are images

  Sources(std::span<const Vec3f> of, std::span<const float> weights_of, Mirror mirror)
      : points(of.begin(), of.end()), weights(weights_of.begin(), weights_of.end()), own(of.size()) {
    if (mirror == Mirror::off) return;
    points.insert(points.end(), of.begin(), of.end());
    weights.insert(weights.end(), weights_of.begin(), weights_of.end());
    for (std::size_t i = 0; i < own; ++i) place(i, of[i]);
  }
  void place(std::size_t i, const Vec3f& p) {
    points[i] = p;
    if (points.size() > own) points[own + i] = {-p.x(), p.y(), p.z()};
  }
};

// Calls visit(i, sums at point i) for every point that is not an image and is asked for; each point in exactly one task.
template <class IsAsked, class Visit>
void for_each_sum(const Sources& sources, float bandwidth, const IsAsked& is_asked, const Visit& visit) {
  const PointGrid grid(sources.points, sources.weights, bandwidth);
  parallel_for(grid.cells(), kCellsPerTask, [&](std::size_t first, std::size_t last) {
    for (std::size_t cell = first; cell < last; ++cell) {
      const auto columns = grid.around(cell);
      const auto [begin, end] = grid.points_of(cell);
      for (std::uint32_t place = begin; place < end; ++place)
        if (const std::uint32_t i = grid.original(place); i < sources.own && is_asked(i))
          visit(i, sums_at(grid.position(place), grid, columns, bandwidth * bandwidth));
    }
  });
}

// Moves every point once that does not rest; returns the longest move.
float shift(Sources& sources, std::vector<std::uint8_t>& rests, const MeanShiftOptions& options) {
  std::vector<Vec3f> moves(sources.own, Vec3f::Zero());
  for_each_sum(
      sources, options.bandwidth, [&](std::size_t i) { return !rests[i]; },
      [&](std::size_t i, const KernelSums& s) {
        if (s.k > 0.0f) moves[i] = options.step * Vec3f(s.x, s.y, s.z) / s.k;
      });
  float longest = 0.0f;
  for (std::size_t i = 0; i < sources.own; ++i) {
    if (rests[i]) continue;
    sources.place(i, sources.points[i] + moves[i]);
    const float move = moves[i].norm();
    longest = std::max(longest, move);
    if (move < options.rest) rests[i] = 1;
  }
  return longest;
}

}  // namespace

MeanShiftResult mean_shift(std::span<const Vec3f> points, std::span<const float> weights, Mirror mirror, const MeanShiftOptions& options) {
  assert(points.size() == weights.size() && options.bandwidth > 0.0f);
  MeanShiftResult result;
  Sources sources(points, weights, mirror);
  std::vector<std::uint8_t> rests(points.size(), 0);
  while (!result.converged && result.iterations < options.most_iterations) {
    result.converged = shift(sources, rests, options) <= options.tolerance;
    ++result.iterations;
  }
  sources.points.resize(sources.own);
  result.points = std::move(sources.points);
  return result;
}

std::vector<float> kernel_density(std::span<const Vec3f> points, std::span<const float> weights, Mirror mirror, float bandwidth) {
  std::vector<float> density(points.size(), 0.0f);
  const float scale = 1.0f / (bandwidth * bandwidth);
  for_each_sum(
      Sources(points, weights, mirror), bandwidth, [](std::size_t) { return true; },
      [&](std::size_t i, const KernelSums& s) { density[i] = scale * s.k; });
  return density;
}

}  // namespace osteon::pipelines
