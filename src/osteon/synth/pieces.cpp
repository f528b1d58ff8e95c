// SPDX-License-Identifier: Apache-2.0
#include "osteon/synth/pieces.h"

#include <cassert>
#include <cmath>
#include <numbers>

#include "osteon/mesh/shapes.h"

namespace osteon::synth {

TriangleMesh block(const Vec3f& centre, const Vec3f& size) {
  return shapes::transformed(shapes::box(size), Transform(Eigen::Translation3f(centre)));
}

TriangleMesh ball(const Vec3f& centre, float radius, int subdivisions) {
  return shapes::transformed(shapes::icosphere(subdivisions, radius), Transform(Eigen::Translation3f(centre)));
}

TriangleMesh tube(const std::vector<Ring>& rings, int corners, const Vec3f& side) {
  assert(rings.size() >= 2 && corners >= 3);
  const Vec3f axis = (rings.back().centre - rings.front().centre).normalized();
  const Vec3f u = (side - axis * axis.dot(side)).normalized(), v = axis.cross(u);
  const float reach = 1.0f / std::cos(std::numbers::pi_v<float> / static_cast<float>(corners));  // a corner lies further out than a side
  const auto n = static_cast<std::uint32_t>(corners);
  TriangleMesh mesh;
  for (const Ring& ring : rings)
    for (std::uint32_t k = 0; k < n; ++k) {
      const float angle = 2.0f * std::numbers::pi_v<float> * (static_cast<float>(k) + 0.5f) / static_cast<float>(n);
      mesh.positions.push_back(ring.centre + reach * (std::cos(angle) * ring.width * u + std::sin(angle) * ring.depth * v));
    }
  const auto corner = [&](std::size_t ring, std::uint32_t k) { return VertexId{static_cast<std::uint32_t>(ring) * n + k % n}; };
  const auto add = [&](VertexId a, VertexId b, VertexId c) { mesh.faces.push_back({a, b, c}); };
  for (std::size_t r = 0; r + 1 < rings.size(); ++r)
    for (std::uint32_t k = 0; k < n; ++k) {
      add(corner(r, k), corner(r, k + 1), corner(r + 1, k + 1));
      add(corner(r, k), corner(r + 1, k + 1), corner(r + 1, k));
    }
  const std::size_t last = rings.size() - 1;
  for (std::uint32_t k = 1; k + 1 < n; ++k) {
    add(corner(0, 0), corner(0, k + 1), corner(0, k));
    add(corner(last, 0), corner(last, k), corner(last, k + 1));
  }
  return mesh;
}

}  // namespace osteon::synth
