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
constexpr float kReach = 0.008f;  // of evened weights: what dense meshes need to look smooth; a fifth of the working mesh's edges
constexpr int kRounds = 8;
constexpr float kLeast = 0.01f;  // of a vertex's largest: what has spread thinner than this is not worth a place

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

// How much of each neighbour's row comes to a vertex in one round: parallel to the neighbourhoods' members. Half of it all where edges are
// short; from there on as much as keeps the variance of the way the same.
std::vector<float> conductances(const TriangleMesh& mesh, const geometry::Neighbourhoods& one_ring) {
  Eigen::AlignedBox3f box;
  for (const Vec3f& p : mesh.positions) box.extend(p);
  const float reach = kReach * box.sizes().maxCoeff(), step = reach / std::sqrt(0.5f * kRounds);
  std::vector<float> out(one_ring.members.size(), 0.0f);
  parallel_for(one_ring.size(), kRowsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const auto neighbours = one_ring.of(v);
      for (std::size_t k = 0; k < neighbours.size(); ++k) {
        const float length = (mesh.positions[VertexId{neighbours[k]}] - mesh.positions[static_cast<VertexId>(v)]).norm();
        const float share = std::min(1.0f, step * step / (length * length));
        if (length < reach) out[one_ring.offsets[v] + k] = 0.5f * share / static_cast<float>(neighbours.size());
      }
    }
  });
  return out;
}

// Rows of a fixed number of places, the largest weight first, joints of weight 0 in those that are left over.
struct FewInfluences {
  std::size_t most;
  std::vector<Influence> places;

  std::span<const Influence> of(std::size_t v) const { return std::span(places).subspan(v * most, most); }
  std::span<Influence> of(std::size_t v) { return std::span(places).subspan(v * most, most); }
};

// Adds rows up joint by joint.
class RowSum {
 public:
  explicit RowSum(std::size_t joints) : sums_(joints, 0.0f) {}
  void add(std::span<const Influence> row, float share) {
    for (const Influence& i : row) {
      if (!(i.weight > 0.0f)) break;
      float& sum = sums_[index(i.joint)];
      if (sum == 0.0f) joints_.push_back(i.joint);
      sum += share * i.weight;
    }
  }
  // The largest of the sums, scaled to the sum 1; forgets all.
  void take_largest(std::span<Influence> out) {
    const auto larger = [&](JointId a, JointId b) {
      const float wa = sums_[index(a)], wb = sums_[index(b)];
      return wa != wb ? wa > wb : a < b;
    };
    const std::size_t kept = std::min(out.size(), joints_.size());
    std::partial_sort(joints_.begin(), joints_.begin() + static_cast<std::ptrdiff_t>(kept), joints_.end(), larger);
    float whole = 0.0f;
    for (std::size_t k = 0; k < kept; ++k) whole += sums_[index(joints_[k])];
    std::ranges::fill(out, Influence{JointId{0}, 0.0f});
    for (std::size_t k = 0; k < kept; ++k) out[k] = {joints_[k], sums_[index(joints_[k])] / whole};
    for (const JointId j : joints_) sums_[index(j)] = 0.0f;
    joints_.clear();
  }

 private:
  std::vector<float> sums_;
  std::vector<JointId> joints_;
};

FewInfluences diffused(const FewInfluences& rows, const geometry::Neighbourhoods& one_ring, const std::vector<float>& conductance,
                       std::size_t joints) {
  FewInfluences out = rows;
  parallel_for(one_ring.size(), kRowsPerTask, [&](std::size_t begin, std::size_t end) {
    RowSum sum(joints);
    for (std::size_t v = begin; v < end; ++v) {
      float kept = 1.0f;
      for (std::size_t k = one_ring.offsets[v]; k < one_ring.offsets[v + 1]; ++k) {
        if (conductance[k] == 0.0f) continue;
        sum.add(rows.of(one_ring.members[k]), conductance[k]);
        kept -= conductance[k];
      }
      if (kept == 1.0f) continue;
      sum.add(rows.of(v), kept);
      sum.take_largest(out.of(v));
    }
  });
  return out;
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

SkinWeights evened(const SkinWeights& weights, const geometry::CleanMesh& clean, std::size_t max_influences) {
  const geometry::Neighbourhoods one_ring = geometry::one_ring(clean.mesh);
  const std::vector<float> conductance = conductances(clean.mesh, one_ring);
  if (std::ranges::all_of(conductance, [](float c) { return c == 0.0f; })) return weights;
  assert(weights.max_influences() <= max_influences);
  FewInfluences rows{max_influences, std::vector<Influence>(one_ring.size() * max_influences, {JointId{0}, 0.0f})};
  std::size_t joints = 0;
  for (VertexId v : clean.from_original.ids()) {
    std::ranges::copy(weights[v], rows.of(index(clean.from_original[v])).begin());
    for (const Influence& i : weights[v]) joints = std::max(joints, index(i.joint) + std::size_t{1});
  }
  for (int round = 0; round < kRounds; ++round) rows = diffused(rows, one_ring, conductance, joints);
  SkinWeights out;
  for (const VertexId v : clean.from_original) {
    const auto row = rows.of(index(v));
    out.append({row.begin(), std::ranges::find_if(row, [&](const Influence& i) { return i.weight < kLeast * row.front().weight; })});
  }
  return out;
}

}  // namespace osteon::skin
