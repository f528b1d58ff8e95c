// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/regions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "osteon/geometry/working_mesh.h"
#include "osteon/mesh/shapes.h"

namespace osteon::geometry {
namespace {

TriangleMesh capsule() { return make_working_mesh(shapes::capsule(0.2f, 1.0f)).mesh; }

TEST(Regions, cover_the_surface_and_hold_their_seeds) {
  const TriangleMesh mesh = capsule();
  const Regions cut = regions(mesh, geodesic_balls(mesh), 64, outermost_vertex(mesh));
  ASSERT_EQ(cut.seeds.size(), 64u);
  ASSERT_EQ(cut.region_of.size(), mesh.positions.size());
  EXPECT_EQ(std::set(cut.seeds.begin(), cut.seeds.end()).size(), 64u);
  for (std::size_t r = 0; r < cut.seeds.size(); ++r) EXPECT_EQ(cut.region_of[cut.seeds[r]], r);
  EXPECT_LT(std::ranges::max(cut.region_of), 64u);
}

// The second seed is as far away as can be: on a capsule whose first seed is on one cap, on the other.
TEST(Regions, seeds_are_far_apart) {
  const TriangleMesh mesh = capsule();
  const auto height = [&](std::uint32_t v) { return mesh.positions.raw()[v].y(); };
  const std::uint32_t first = outermost_vertex(mesh);
  const Regions cut = regions(mesh, geodesic_balls(mesh), 2, first);
  EXPECT_NEAR(height(cut.seeds[0]) + height(cut.seeds[1]), 1.0f, 0.02f);  // normalised: from 0 to 1
  for (std::uint32_t v = 0; v < mesh.positions.size(); ++v) {
    if (std::abs(height(v) - 0.5f) < 0.05f) continue;
    EXPECT_EQ(cut.region_of[v], (height(v) > 0.5f) == (height(first) > 0.5f) ? 0u : 1u);
  }
}

// Parts that no way leads to come first: nothing is farther.
TEST(Regions, of_separate_parts_do_not_mix) {
  const TriangleMesh one = shapes::icosphere(2, 0.1f);
  const std::size_t of_one = one.positions.size();
  TriangleMesh other = one;
  for (Vec3f& p : other.positions) p += Vec3f(0.8f, 0.0f, 0.0f);
  const TriangleMesh mesh = shapes::merged(one, other);
  const Regions cut = regions(mesh, geodesic_balls(mesh), 2, 0);
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) EXPECT_EQ(cut.region_of[v], v < of_one ? 0u : 1u);
}

TEST(Regions, are_not_more_than_there_are_vertices) {
  TriangleMesh mesh;
  for (const Vec3f& p : {Vec3f(0, 0, 0), Vec3f(1, 0, 0), Vec3f(0, 1, 0)}) mesh.positions.push_back(p);
  const Regions cut = regions(mesh, geodesic_balls(mesh), 64, 1);
  EXPECT_EQ(cut.seeds, (std::vector<std::uint32_t>{1, 0, 2}));
  EXPECT_EQ(cut.region_of, (std::vector<std::uint32_t>{1, 0, 2}));
}

}  // namespace
}  // namespace osteon::geometry
