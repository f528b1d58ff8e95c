// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/neighbourhoods.h"

#include <algorithm>
#include <cassert>
#include <functional>
#include <limits>
#include <numeric>
#include <utility>

#include "osteon/base/parallel.h"
#include "osteon/geometry/surface_graph.h"

namespace osteon::geometry {
namespace {

constexpr std::size_t kGrain = 64;

struct Member {
  float distance;
  std::uint32_t vertex;
  auto operator<=>(const Member&) const = default;
};

// The ball around one vertex after the other; the distances of the last one are wiped before the next.
class BallSearch {
 public:
  BallSearch(const SurfaceGraph& graph, float radius, std::size_t most)
      : graph_(graph), radius_(radius), most_(most), distances_(graph.size(), std::numeric_limits<float>::infinity()) {}

  // Nearest first; valid until the next call.
  std::span<const Member> around(std::uint32_t center) {
    for (std::uint32_t v : touched_) distances_[v] = std::numeric_limits<float>::infinity();
    touched_.clear();
    heap_.clear();
    ball_.clear();
    reach(center, 0.0f);
    while (!heap_.empty()) {
      std::ranges::pop_heap(heap_, std::greater{});
      const Member next = heap_.back();
      heap_.pop_back();
      if (next.distance > distances_[next.vertex]) continue;  // outdated
      // Equally far members may still follow the last one that fits: which of them stay is decided below, by index.
      if (ball_.size() >= most_ && next.distance > ball_[most_ - 1].distance) break;
      if (next.vertex != center) ball_.push_back(next);
      for (const auto& [to, length] : graph_.of(next.vertex)) reach(to, next.distance + length);
    }
    std::ranges::sort(ball_);
    return std::span(ball_).first(std::min(most_, ball_.size()));
  }

 private:
  void reach(std::uint32_t v, float distance) {
    if (distance > radius_ || distance >= distances_[v]) return;
    distances_[v] = distance;
    touched_.push_back(v);
    heap_.push_back({distance, v});
    std::ranges::push_heap(heap_, std::greater{});
  }

  const SurfaceGraph& graph_;
  float radius_;
  std::size_t most_;
  std::vector<float> distances_;
  std::vector<std::uint32_t> touched_;
  std::vector<Member> heap_, ball_;
};

// Row v of the result holds those members of ball v whose ranks `choose(v, ball size)` names, ascending.
template <class Choose>
Neighbourhoods chosen(const GeodesicBalls& balls, std::size_t most, Choose choose) {
  Neighbourhoods out;
  for (std::size_t v = 0; v < balls.members.size(); ++v) {
    const auto ball = balls.members.of(v);
    if (ball.size() <= most)
      out.members.insert(out.members.end(), ball.begin(), ball.end());
    else
      for (std::size_t rank : choose(ball.size())) out.members.push_back(ball[rank]);
    out.offsets.push_back(static_cast<std::uint32_t>(out.members.size()));
  }
  return out;
}

}  // namespace

Neighbourhoods one_ring(const TriangleMesh& mesh) {
  const std::size_t vertices = mesh.positions.size();
  std::vector<std::pair<VertexId, VertexId>> pairs;
  pairs.reserve(6 * mesh.faces.size());
  for (const Triangle& t : mesh.faces)
    for (VertexId a : t)
      for (VertexId b : t)
        if (a != b) pairs.emplace_back(a, b);
  std::ranges::sort(pairs);
  const auto copies = std::ranges::unique(pairs);
  pairs.erase(copies.begin(), copies.end());
  Neighbourhoods out;
  out.offsets.assign(vertices + 1, 0);
  for (const auto& [a, b] : pairs) {
    ++out.offsets[index(a) + 1];
    out.members.push_back(static_cast<std::uint32_t>(b));
  }
  std::partial_sum(out.offsets.begin(), out.offsets.end(), out.offsets.begin());
  return out;
}

GeodesicBalls geodesic_balls(const TriangleMesh& mesh, float radius, std::size_t most) {
  assert(most > 0);
  const SurfaceGraph graph = surface_graph(mesh, radius / 3.0f);
  std::vector<std::vector<Member>> balls(graph.size());
  parallel_for(graph.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    BallSearch search(graph, radius, most);
    for (std::size_t v = begin; v < end; ++v) {
      const auto ball = search.around(static_cast<std::uint32_t>(v));
      balls[v].assign(ball.begin(), ball.end());
    }
  });
  GeodesicBalls out;
  for (const auto& ball : balls) {
    for (const auto& [distance, vertex] : ball) {
      out.members.members.push_back(vertex);
      out.distances.push_back(distance);
    }
    out.members.offsets.push_back(static_cast<std::uint32_t>(out.distances.size()));
  }
  return out;
}

Neighbourhoods evenly(const GeodesicBalls& balls, std::size_t most) {
  return chosen(balls, most, [&](std::size_t size) {
    std::vector<std::size_t> ranks(most);
    for (std::size_t i = 0; i < most; ++i) ranks[i] = (2 * i + 1) * size / (2 * most);  // the middles of `most` equal parts
    return ranks;
  });
}

Neighbourhoods drawn(const GeodesicBalls& balls, std::size_t most, Random& random) {
  std::vector<std::size_t> ranks;
  return chosen(balls, most, [&](std::size_t size) {
    ranks.resize(size);
    std::iota(ranks.begin(), ranks.end(), std::size_t{0});
    for (std::size_t i = 0; i < most; ++i) std::swap(ranks[i], ranks[i + random.below(size - i)]);  // the start of a Fisher-Yates shuffle
    ranks.resize(most);
    std::ranges::sort(ranks);
    return std::span<const std::size_t>(ranks);
  });
}

}  // namespace osteon::geometry
