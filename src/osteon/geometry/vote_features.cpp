// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/vote_features.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "osteon/base/parallel.h"
#include "osteon/geometry/bvh.h"

namespace osteon::geometry {
namespace {

constexpr std::size_t kGrain = 64;
constexpr float kStart = 1e-3f;  // below the surface, so that the vertex's own faces are not met
constexpr int kAround = 6;
constexpr float kConeAngle = 40.0f * std::numbers::pi_v<float> / 180.0f;
using Directions = std::array<Vec3f, 1 + kAround>;

Directions inward_rays(const Vec3f& normal) {
  const Vec3f u = normal.unitOrthogonal(), v = normal.cross(u);
  Directions out{-normal};
  for (int k = 0; k < kAround; ++k) {
    const float angle = 2.0f * std::numbers::pi_v<float> * static_cast<float>(k) / kAround;
    out[static_cast<std::size_t>(k) + 1] =
        std::sin(kConeAngle) * (std::cos(angle) * u + std::sin(angle) * v) - std::cos(kConeAngle) * normal;
  }
  return out;
}

}  // namespace

VoteFeatures vote_features(const TriangleMesh& mesh) {
  VoteFeatures out{vertex_normals(mesh), PerVertex<Vec3f>(mesh.positions.size()), PerVertex<float>(mesh.positions.size())};
  const Bvh surface(mesh);
  parallel_for(mesh.positions.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto v = static_cast<VertexId>(i);
      const Vec3f origin = mesh.positions[v] - kStart * out.normals[v];
      std::array<float, 1 + kAround> lengths;
      std::size_t hits = 0;
      Vec3f sum = Vec3f::Zero();
      for (const Vec3f& direction : inward_rays(out.normals[v])) {
        const auto hit = surface.first_hit(origin, direction);
        if (!hit || area_vector(mesh, hit->face).dot(direction) <= 0.0f) continue;
        lengths[hits++] = hit->distance;
        sum += 0.5f * hit->distance * direction;
      }
      if (hits == 0) continue;
      const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(hits / 2);
      std::nth_element(lengths.begin(), middle, lengths.begin() + static_cast<std::ptrdiff_t>(hits));
      out.to_middle[v] = origin + sum / static_cast<float>(hits) - mesh.positions[v];
      out.thicknesses[v] = *middle;
    }
  });
  return out;
}

std::vector<float> vote_rows(std::span<const Vec3f> positions, const VoteFeatures& features, float joints) {
  const float detail = std::log(joints) - 3.0f;  // about zero in the middle
  std::vector<float> rows;
  rows.reserve(features.normals.size() * kVoteFeatures);
  for (VertexId v : features.normals.ids()) {
    for (const Vec3f& vector : {features.normals[v], features.to_middle[v]}) rows.insert(rows.end(), vector.begin(), vector.end());
    rows.push_back(features.thicknesses[v]);
    rows.push_back(detail);
    const Vec3f middle = positions[index(v)] + features.to_middle[v];
    for (const float frequency : {2.0f, 4.0f, 8.0f})
      for (const float x : middle) {
        const float angle = frequency * std::numbers::pi_v<float> * x;
        rows.push_back(std::sin(angle));
        rows.push_back(std::cos(angle));
      }
  }
  return rows;
}

}  // namespace osteon::geometry
