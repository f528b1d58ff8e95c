// SPDX-License-Identifier: Apache-2.0
// Meshes as no artist should make them: every vertex has weights that sum to 1, by every method.
#include <array>
#include <cmath>
#include <string>

#include "geometry/mesh_makers.h"
#include "osteon/base/random.h"
#include "osteon/skin/bind.h"
#include "support/expect.h"

namespace osteon::skin {
namespace {

constexpr std::array kMethods{Method::rigid, Method::geovoxel, Method::heat, Method::biharmonic};

Vec3f anywhere(Random& random, float size) {
  Vec3f p;
  for (float& x : p) x = size * random.normal();
  return p;
}

TriangleMesh ball(Random& random) {
  const TriangleMesh sphere = shapes::icosphere(1, random.uniform(0.05f, 0.35f));
  return test::moved(sphere, anywhere(random, 0.4f));
}

// Open, with faces that look both ways, points used twice, faces through one another.
TriangleMesh pieces(Random& random) {
  TriangleMesh mesh = shapes::sheet(3 + static_cast<int>(random.below(6)), 4);
  const std::size_t parts = 1 + random.below(12);
  for (std::size_t k = 0; k < parts; ++k) {
    TriangleMesh part = random.below(3) == 0 ? test::moved(shapes::sheet(2, 3), anywhere(random, 0.5f)) : ball(random);
    if (random.below(2) == 0) part = test::flipped(part);
    if (random.below(4) == 0) part = test::unshared(part);
    if (random.below(4) == 0) part = shapes::merged(part, part);
    mesh = shapes::merged(mesh, part);
  }
  for (std::size_t k = 0; k < random.below(8); ++k) mesh.positions.push_back(anywhere(random, 2.0f));  // of no face
  return mesh;
}

Skeleton any_skeleton(Random& random) {
  Skeleton s;
  s.add("root", std::nullopt, anywhere(random, 0.3f));
  const std::size_t joints = random.below(8);
  for (std::size_t j = 1; j <= joints; ++j)
    s.add("j" + std::to_string(j), static_cast<JointId>(random.below(j)),
          random.below(4) == 0 ? s.rest_positions[JointId{0}] : anywhere(random, 0.6f));
  return s;
}

void expect_exact(const SkinWeights& weights, const TriangleMesh& mesh, const Skeleton& skeleton) {
  validate(weights, mesh.positions.size(), skeleton.size());
  for (VertexId v : mesh.positions.ids()) {
    double sum = 0.0;
    for (const Influence& i : weights[v]) sum += static_cast<double>(i.weight);
    ASSERT_NEAR(sum, 1.0, 3e-7);
  }
}

TEST(Torture, a_hundred_heaps_of_pieces) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    Random random(seed);
    const TriangleMesh mesh = pieces(random);
    const Skeleton skeleton = any_skeleton(random);
    BindOptions options;
    options.method = kMethods[seed % kMethods.size()];
    options.resolution = 48;
    SCOPED_TRACE(seed);
    expect_exact(bind(mesh, skeleton, options).weights, mesh, skeleton);
  }
}

TEST(Torture, five_hundred_parts) {
  Random random(5);
  TriangleMesh mesh = shapes::icosphere(2, 0.5f);
  for (int k = 0; k < 500; ++k) mesh = shapes::merged(mesh, test::moved(shapes::icosphere(0, 0.02f), anywhere(random, 0.5f)));
  const Skeleton skeleton = any_skeleton(random);
  for (const Method method : kMethods) {
    BindOptions options;
    options.method = method;
    options.resolution = 96;
    expect_exact(bind(mesh, skeleton, options).weights, mesh, skeleton);
  }
}

TEST(Torture, a_million_triangles) {
  const TriangleMesh mesh = shapes::sheet(708, 708);
  ASSERT_GT(mesh.faces.size(), 1'000'000u);
  Skeleton skeleton;
  const JointId root = skeleton.add("root", std::nullopt, {0, 0, 0});
  skeleton.add("tip", root, {0.4f, 0.4f, 0});
  BindOptions options;
  options.resolution = 128;
  expect_exact(bind(mesh, skeleton, options).weights, mesh, skeleton);
}

}  // namespace
}  // namespace osteon::skin
