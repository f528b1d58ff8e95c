// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "geometry/mesh_makers.h"
#include "osteon/base/random.h"
#include "osteon/rig/skeleton.h"
#include "osteon/rig/skin_weights.h"

// Meshes and skeletons as no artist should make them.
namespace osteon::test {

inline Vec3f anywhere(Random& random, float size) {
  Vec3f p;
  for (float& x : p) x = size * random.normal();
  return p;
}

inline TriangleMesh ball(Random& random) {
  const TriangleMesh sphere = shapes::icosphere(1, random.uniform(0.05f, 0.35f));
  return shapes::shifted(sphere, anywhere(random, 0.4f));
}

// Open, with faces that look both ways, points used twice, faces through one another.
inline TriangleMesh heap_of_pieces(Random& random) {
  TriangleMesh mesh = shapes::sheet(3 + static_cast<int>(random.below(6)), 4);
  const std::size_t parts = 1 + random.below(12);
  for (std::size_t k = 0; k < parts; ++k) {
    TriangleMesh part = random.below(3) == 0 ? shapes::shifted(shapes::sheet(2, 3), anywhere(random, 0.5f)) : ball(random);
    if (random.below(2) == 0) part = flipped(part);
    if (random.below(4) == 0) part = unshared(part);
    if (random.below(4) == 0) part = shapes::merged(part, part);
    mesh = shapes::merged(mesh, part);
  }
  for (std::size_t k = 0; k < random.below(8); ++k) mesh.positions.push_back(anywhere(random, 2.0f));  // of no face
  return mesh;
}

inline Skeleton any_skeleton(Random& random) {
  Skeleton s;
  s.add("root", std::nullopt, anywhere(random, 0.3f));
  const std::size_t joints = random.below(8);
  for (std::size_t j = 1; j <= joints; ++j)
    s.add("j" + std::to_string(j), static_cast<JointId>(random.below(j)),
          random.below(4) == 0 ? s.rest_positions[JointId{0}] : anywhere(random, 0.6f));
  return s;
}

// Every vertex has weights, and they sum to 1 as exactly as floats can.
inline void expect_exact(const SkinWeights& weights, const TriangleMesh& mesh, const Skeleton& skeleton) {
  validate(weights, mesh.positions.size(), skeleton.size());
  for (VertexId v : mesh.positions.ids()) {
    double sum = 0.0;
    for (const Influence& i : weights[v]) sum += static_cast<double>(i.weight);
    ASSERT_NEAR(sum, 1.0, 3e-7);
  }
}

}  // namespace osteon::test
