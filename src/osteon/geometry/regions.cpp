// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/regions.h"

#include <algorithm>
#include <limits>
#include <queue>

namespace osteon::geometry {
namespace {

constexpr std::size_t kSteps = 8;  // members of a ball that a way may lead to
constexpr float kFar = std::numeric_limits<float>::infinity();

struct Reached {
  float distance;
  std::uint32_t vertex;
  bool operator>(const Reached& other) const { return distance > other.distance || (distance == other.distance && vertex > other.vertex); }
};

struct Growth {
  std::vector<float> distance;           // (V) to the nearest seed
  std::vector<std::uint32_t> region_of;  // (V)
};

// The new seed takes what is nearer to it than to all before it.
void grow(Growth& state, const GeodesicBalls& balls, std::uint32_t seed, std::uint32_t region) {
  std::priority_queue<Reached, std::vector<Reached>, std::greater<>> next;
  const auto reach = [&](std::uint32_t v, float distance) {
    if (!(distance < state.distance[v])) return;
    state.distance[v] = distance;
    state.region_of[v] = region;
    next.push({distance, v});
  };
  reach(seed, 0.0f);
  while (!next.empty()) {
    const Reached here = next.top();
    next.pop();
    if (here.distance > state.distance[here.vertex]) continue;
    const auto members = balls.members.of(here.vertex);
    const auto distances = balls.distances_of(here.vertex);
    for (std::size_t i = 0; i < std::min(kSteps, members.size()); ++i) reach(members[i], here.distance + distances[i]);
  }
}

std::uint32_t nearest_seed(const TriangleMesh& mesh, const std::vector<std::uint32_t>& seeds, std::uint32_t v) {
  const auto squared = [&](std::uint32_t seed) { return (mesh.positions.raw()[seed] - mesh.positions.raw()[v]).squaredNorm(); };
  return static_cast<std::uint32_t>(std::ranges::min_element(seeds, {}, squared) - seeds.begin());
}

}  // namespace

Regions regions(const TriangleMesh& mesh, const GeodesicBalls& balls, std::size_t count, std::uint32_t first) {
  const std::size_t vertices = mesh.positions.size();
  Growth state{std::vector<float>(vertices, kFar), std::vector<std::uint32_t>(vertices, 0)};
  Regions out;
  std::uint32_t seed = first;
  while (out.seeds.size() < std::min(count, vertices)) {
    grow(state, balls, seed, static_cast<std::uint32_t>(out.seeds.size()));
    out.seeds.push_back(seed);
    seed = static_cast<std::uint32_t>(std::ranges::max_element(state.distance) - state.distance.begin());
    if (state.distance[seed] == 0.0f) break;  // only vertices in one place with a seed are left
  }
  for (std::uint32_t v = 0; v < vertices; ++v)
    if (state.distance[v] == kFar) state.region_of[v] = nearest_seed(mesh, out.seeds, v);
  out.region_of = std::move(state.region_of);
  return out;
}

std::uint32_t outermost_vertex(const TriangleMesh& mesh) {
  const std::vector<Vec3f>& positions = mesh.positions.raw();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Vec3f& p : positions) sum += p.cast<double>();
  const Vec3f middle = (sum / static_cast<double>(positions.size())).cast<float>();
  const auto squared = [&](const Vec3f& p) { return (p - middle).squaredNorm(); };
  return static_cast<std::uint32_t>(std::ranges::max_element(positions, {}, squared) - positions.begin());
}

}  // namespace osteon::geometry
