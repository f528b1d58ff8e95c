// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include "osteon/mesh/triangle_mesh.h"

namespace osteon::test {

// A closed tube of round section along a path in the plane z = 0: watertight, facing outwards. Pre: neighbouring points differ.
inline TriangleMesh tube(const std::vector<Vec3f>& path, float radius, int segments = 16) {
  TriangleMesh mesh;
  const auto direction = [&](std::size_t i) -> Vec3f {
    return (path[std::min(i + 1, path.size() - 1)] - path[i > 0 ? i - 1 : 0]).normalized();
  };
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Vec3f u = Vec3f::UnitZ(), v = direction(i).cross(u);
    for (int s = 0; s < segments; ++s) {
      const float angle = 2.0f * std::numbers::pi_v<float> * static_cast<float>(s) / static_cast<float>(segments);
      mesh.positions.push_back(path[i] + radius * (std::cos(angle) * u + std::sin(angle) * v));
    }
  }
  const auto ring = [&](std::size_t i, int s) {
    return static_cast<VertexId>(i * static_cast<std::size_t>(segments) + static_cast<std::size_t>(s % segments));
  };
  for (std::size_t i = 0; i + 1 < path.size(); ++i)
    for (int s = 0; s < segments; ++s) {
      mesh.faces.push_back({ring(i, s), ring(i, s + 1), ring(i + 1, s + 1)});
      mesh.faces.push_back({ring(i, s), ring(i + 1, s + 1), ring(i + 1, s)});
    }
  const VertexId first = mesh.positions.push_back(path.front()), last = mesh.positions.push_back(path.back());
  for (int s = 0; s < segments; ++s) {
    mesh.faces.push_back({first, ring(0, s + 1), ring(0, s)});
    mesh.faces.push_back({last, ring(path.size() - 1, s), ring(path.size() - 1, s + 1)});
  }
  return mesh;
}

// Two arms along +y, joined by a half circle at the bottom:
//   a     b     at height `length`, `gap` between the arms' surfaces
//   |     |
//    \___/      around the origin
struct UTube {
  TriangleMesh mesh;
  Segment left;       // the axis of the left arm
  float center_line;  // from tip to tip
  float spread;       // distance of the two axes
};
inline UTube u_tube(float radius, float gap, float length, int rings = 40) {
  const float bend = radius + 0.5f * gap, pi = std::numbers::pi_v<float>;
  std::vector<Vec3f> path;
  for (int i = rings; i > 0; --i) path.emplace_back(-bend, length * static_cast<float>(i) / static_cast<float>(rings), 0.0f);
  for (int i = 0; i <= rings; ++i) {
    const float angle = pi * static_cast<float>(i) / static_cast<float>(rings);
    path.emplace_back(-bend * std::cos(angle), -bend * std::sin(angle), 0.0f);
  }
  for (int i = 1; i <= rings; ++i) path.emplace_back(bend, length * static_cast<float>(i) / static_cast<float>(rings), 0.0f);
  return {tube(path, radius), {{-bend, length, 0}, {-bend, 0, 0}}, 2 * length + pi * bend, 2 * bend};
}

}  // namespace osteon::test
