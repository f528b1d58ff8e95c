// SPDX-License-Identifier: Apache-2.0
// Meshes as no artist should make them: every vertex has weights that sum to 1, by every method.
#include <array>
#include <cmath>
#include <string>

#include "geometry/mesh_makers.h"
#include "osteon/base/random.h"
#include "osteon/skin/bind.h"
#include "skin/heaps.h"
#include "support/expect.h"

namespace osteon::skin {
namespace {

constexpr std::array kMethods{Method::rigid, Method::geovoxel, Method::heat, Method::biharmonic};

TEST(Torture, a_hundred_heaps_of_pieces) {
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    Random random(seed);
    const TriangleMesh mesh = test::heap_of_pieces(random);
    const Skeleton skeleton = test::any_skeleton(random);
    BindOptions options;
    options.method = kMethods[seed % kMethods.size()];
    options.resolution = 48;
    SCOPED_TRACE(seed);
    test::expect_exact(bind(mesh, skeleton, options).weights, mesh, skeleton);
  }
}

TEST(Torture, five_hundred_parts) {
  Random random(5);
  TriangleMesh mesh = shapes::icosphere(2, 0.5f);
  for (int k = 0; k < 500; ++k) mesh = shapes::merged(mesh, shapes::shifted(shapes::icosphere(0, 0.02f), test::anywhere(random, 0.5f)));
  const Skeleton skeleton = test::any_skeleton(random);
  for (const Method method : kMethods) {
    BindOptions options;
    options.method = method;
    options.resolution = 96;
    test::expect_exact(bind(mesh, skeleton, options).weights, mesh, skeleton);
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
  test::expect_exact(bind(mesh, skeleton, options).weights, mesh, skeleton);
}

}  // namespace
}  // namespace osteon::skin
