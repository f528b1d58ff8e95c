// SPDX-License-Identifier: Apache-2.0
#include "osteon/skin/weight_cleanup.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <vector>

#include "osteon/base/parallel.h"

namespace osteon::skin {
namespace {

constexpr std::size_t kRowsPerTask = 256;

bool is_empty(const Matrix& weights, std::size_t row) { return !(weights.row(static_cast<Eigen::Index>(row)).maxCoeff() > 0.0f); }

void prune_row(std::span<float> row, float share, std::size_t most, std::vector<std::uint32_t>& order) {
  for (float& w : row)
    if (!(w > 0.0f) || !std::isfinite(w)) w = 0.0f;
  const float least = share * *std::ranges::max_element(row);
  for (float& w : row)
    if (w < least) w = 0.0f;
  if (most < row.size()) {
    order.resize(row.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto larger = [&](std::uint32_t a, std::uint32_t b) { return row[a] != row[b] ? row[a] > row[b] : a < b; };
    std::nth_element(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(most), order.end(), larger);
    for (std::size_t k = most; k < order.size(); ++k) row[order[k]] = 0.0f;
  }
  const double sum = std::accumulate(row.begin(), row.end(), 0.0);
  if (sum > 0.0)
    for (float& w : row) w = static_cast<float>(static_cast<double>(w) / sum);
}

// For every vertex the filled vertex that is fewest edges away: breadth first from all filled vertices at once, in index order.
std::vector<std::optional<std::uint32_t>> nearest_filled(const std::vector<bool>& filled, const geometry::Neighbourhoods& one_ring) {
  std::vector<std::optional<std::uint32_t>> nearest(filled.size());
  std::vector<std::uint32_t> front;
  for (std::uint32_t v = 0; v < filled.size(); ++v)
    if (filled[v]) {
      nearest[v] = v;
      front.push_back(v);
    }
  for (std::size_t k = 0; k < front.size(); ++k)
    for (std::uint32_t n : one_ring.of(front[k]))
      if (!nearest[n]) {
        nearest[n] = nearest[front[k]];
        front.push_back(n);
      }
  return nearest;
}

std::optional<std::uint32_t> nearest_in_space(const Vec3f& p, const std::vector<bool>& filled, const PerVertex<Vec3f>& positions) {
  std::optional<std::uint32_t> best;
  float least = std::numeric_limits<float>::infinity();
  for (std::uint32_t v = 0; v < filled.size(); ++v)
    if (const float d = (positions[VertexId{v}] - p).squaredNorm(); filled[v] && d < least) {
      least = d;
      best = v;
    }
  return best;
}

// Non-zero entries of every row, so that blending does not walk over all joints.
std::vector<std::vector<Influence>> sparse_rows(const Matrix& weights) {
  std::vector<std::vector<Influence>> rows(static_cast<std::size_t>(weights.rows()));
  for (std::size_t v = 0; v < rows.size(); ++v)
    for (Eigen::Index j = 0; j < weights.cols(); ++j)
      if (const float w = weights(static_cast<Eigen::Index>(v), j); w > 0.0f) rows[v].push_back({static_cast<JointId>(j), w});
  return rows;
}

}  // namespace

Matrix smooth_rows(const Matrix& weights, const geometry::Neighbourhoods& one_ring) {
  assert(static_cast<std::size_t>(weights.rows()) == one_ring.size());
  Matrix out(weights.rows(), weights.cols());
  parallel_for(one_ring.size(), kRowsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      auto row = out.row(static_cast<Eigen::Index>(v));
      row = weights.row(static_cast<Eigen::Index>(v));
      for (std::uint32_t n : one_ring.of(v)) row += weights.row(static_cast<Eigen::Index>(n));
      row /= static_cast<float>(one_ring.of(v).size() + 1);
    }
  });
  return out;
}

void prune_rows(Matrix& weights, float share, std::size_t most) {
  assert(most > 0 && weights.cols() > 0);
  const auto columns = static_cast<std::size_t>(weights.cols());
  parallel_for(static_cast<std::size_t>(weights.rows()), kRowsPerTask, [&](std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> order;
    for (std::size_t v = begin; v < end; ++v) prune_row({weights.data() + v * columns, columns}, share, most, order);
  });
}

std::size_t fill_empty_rows(Matrix& weights, const PerVertex<Vec3f>& positions, const geometry::Neighbourhoods& one_ring) {
  const std::size_t n = positions.size();
  std::vector<bool> filled(n);
  for (std::size_t v = 0; v < n; ++v) filled[v] = !is_empty(weights, v);
  const auto missing = static_cast<std::size_t>(std::ranges::count(filled, false));
  if (missing == 0 || missing == n) return 0;
  const auto along_edges = nearest_filled(filled, one_ring);
  for (std::size_t v = 0; v < n; ++v) {
    if (filled[v]) continue;
    const auto source = along_edges[v] ? along_edges[v] : nearest_in_space(positions[static_cast<VertexId>(v)], filled, positions);
    weights.row(static_cast<Eigen::Index>(v)) = weights.row(static_cast<Eigen::Index>(*source));
  }
  return missing;
}

SkinWeights weights_on_original(const Matrix& weights, const PerVertex<geometry::SurfacePoint>& places, std::size_t max_influences) {
  const auto rows = sparse_rows(weights);
  SkinWeights out;
  std::vector<Influence> blended;
  for (const geometry::SurfacePoint& place : places) {
    blended.clear();
    for (std::size_t corner = 0; corner < 3; ++corner)
      for (const Influence& i : rows[index(place.vertices[corner])]) blended.push_back({i.joint, place.weights[corner] * i.weight});
    [[maybe_unused]] const bool has_weight = out.append(blended, max_influences);
    assert(has_weight);
  }
  return out;
}

}  // namespace osteon::skin
