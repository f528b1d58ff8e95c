// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/neighbourhoods.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "mesh_makers.h"
#include "osteon/base/parallel.h"
#include "osteon/mesh/shapes.h"
#include "support/expect.h"

namespace osteon::geometry {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

// A sphere without symmetries, so that no two distances are equal.
TriangleMesh potato(int subdivisions) {
  TriangleMesh mesh = shapes::icosphere(subdivisions, 0.5f);
  Random random(7);
  for (Vec3f& p : mesh.positions) p *= random.uniform(0.97f, 1.03f);
  return mesh;
}

// Vertex v of the result is vertex order[v] of the mesh.
TriangleMesh renumbered(const TriangleMesh& mesh, const std::vector<std::uint32_t>& order) {
  TriangleMesh out;
  std::vector<std::uint32_t> place(order.size());
  for (std::uint32_t v = 0; v < order.size(); ++v) {
    out.positions.push_back(mesh.positions[VertexId{order[v]}]);
    place[order[v]] = v;
  }
  for (const auto& [a, b, c] : mesh.faces)
    out.faces.push_back({VertexId{place[index(a)]}, VertexId{place[index(b)]}, VertexId{place[index(c)]}});
  return out;
}

std::vector<std::uint32_t> shuffled(std::size_t n) {
  std::vector<std::uint32_t> order(n);
  std::iota(order.begin(), order.end(), 0u);
  Random random(3);
  random.shuffle(std::span(order));
  return order;
}

bool connected(const GeodesicBalls& balls, std::size_t a, std::size_t b) {
  const auto ball = balls.members.of(a);
  return std::ranges::find(ball, static_cast<std::uint32_t>(b)) != ball.end();
}

TEST(OneRing, of_a_box_corner_has_each_neighbour_once) {
  const Neighbourhoods rings = one_ring(shapes::box({1, 1, 1}));
  EXPECT_EQ(rings.size(), 8u);
  EXPECT_THAT(rings.of(0), ElementsAre(1, 2, 3, 4, 5, 6));
}

TEST(OneRing, of_a_closed_surface_counts_every_edge_twice) {
  const TriangleMesh sphere = shapes::icosphere(3);
  EXPECT_EQ(one_ring(sphere).members.size(), 3 * sphere.faces.size());
}

TEST(OneRing, is_empty_without_faces) {
  TriangleMesh mesh = shapes::box({1, 1, 1});
  mesh.positions.push_back(Vec3f(5, 5, 5));
  EXPECT_THAT(one_ring(mesh).of(8), IsEmpty());
  mesh.faces = {};
  EXPECT_EQ(one_ring(mesh).size(), 9u);
}

TEST(GeodesicBalls, distances_on_a_plane_are_nearly_euclidean) {
  const TriangleMesh sheet = shapes::sheet(40, 40);
  const GeodesicBalls balls = geodesic_balls(sheet, 0.2f, 10000);
  for (std::size_t v = 0; v < balls.members.size(); ++v)
    for (std::size_t i = 0; i < balls.members.of(v).size(); ++i) {
      const float straight = (sheet.positions.raw()[v] - sheet.positions.raw()[balls.members.of(v)[i]]).norm();
      EXPECT_GE(balls.distances_of(v)[i], 0.9999f * straight);
      EXPECT_LE(balls.distances_of(v)[i], 1.09f * straight);  // eight directions: at worst 1 / cos(pi / 8) = 1.082
    }
}

TEST(GeodesicBalls, distances_on_a_sphere_are_nearly_great_circles) {
  const TriangleMesh sphere = shapes::icosphere(4);
  const GeodesicBalls balls = geodesic_balls(sphere, 0.5f, 10000);
  for (std::size_t v = 0; v < balls.members.size(); ++v)
    for (std::size_t i = 0; i < balls.members.of(v).size(); ++i) {
      const Vec3f &a = sphere.positions.raw()[v], &b = sphere.positions.raw()[balls.members.of(v)[i]];
      const float arc = std::acos(std::clamp(a.dot(b), -1.0f, 1.0f));
      EXPECT_GT(balls.distances_of(v)[i], 0.99f * arc);  // edges are chords
      EXPECT_LT(balls.distances_of(v)[i], 1.07f * arc);
    }
}

TEST(GeodesicBalls, are_sorted_and_mutual) {
  const GeodesicBalls balls = geodesic_balls(potato(4), 0.1f, 10000);
  for (std::size_t v = 0; v < balls.members.size(); ++v) {
    EXPECT_TRUE(std::ranges::is_sorted(balls.distances_of(v)));
    EXPECT_FALSE(connected(balls, v, v));
    for (std::uint32_t u : balls.members.of(v)) EXPECT_TRUE(connected(balls, u, v));
  }
}

TEST(GeodesicBalls, keep_the_nearest_when_full) {
  const TriangleMesh mesh = potato(4);
  const GeodesicBalls all = geodesic_balls(mesh, 0.2f, 10000), some = geodesic_balls(mesh, 0.2f, 20);
  for (std::size_t v = 0; v < all.members.size(); ++v) {
    ASSERT_GT(all.members.of(v).size(), 20u);
    EXPECT_TRUE(std::ranges::equal(some.members.of(v), all.members.of(v).first(20)));
  }
}

TEST(GeodesicBalls, do_not_reach_across_a_gap_between_two_limbs) {
  const TriangleMesh limbs = shapes::merged(shapes::icosphere(3, 0.25f), shapes::shifted(shapes::icosphere(3, 0.25f), {0.501f, 0, 0}));
  const GeodesicBalls balls = geodesic_balls(limbs);
  for (std::size_t v = 0; v < 642; ++v)
    for (std::uint32_t u : balls.members.of(v)) EXPECT_LT(u, 642u);
}

TEST(GeodesicBalls, reach_from_cloth_to_the_body_under_it) {
  const TriangleMesh body = shapes::sheet(30, 30), cloth = shapes::shifted(shapes::sheet(7, 7), {0.0f, 0.0f, 0.005f});
  const GeodesicBalls balls = geodesic_balls(shapes::merged(body, cloth));
  for (std::size_t v = body.positions.size(); v < balls.members.size(); ++v)  // the cloth's vertices are farther apart than the radius
    EXPECT_TRUE(std::ranges::any_of(balls.members.of(v), [&](std::uint32_t u) { return u < body.positions.size(); }));
}

TEST(GeodesicBalls, do_not_reach_from_one_side_of_a_thin_part_to_the_other) {
  const TriangleMesh front = shapes::sheet(30, 30), back = shapes::shifted(test::flipped(front), {0, 0, -0.005f});
  const GeodesicBalls balls = geodesic_balls(shapes::merged(front, back));
  for (std::size_t v = 0; v < front.positions.size(); ++v)
    for (std::uint32_t u : balls.members.of(v)) EXPECT_LT(u, front.positions.size());
}

TEST(GeodesicBalls, isolated_vertices_are_joined_to_the_surface_they_lie_on_or_left_alone) {
  TriangleMesh mesh = shapes::sheet(30, 30);
  const std::size_t near_one = index(mesh.positions.push_back(mesh.positions[VertexId{100}] + Vec3f(0, 0, 0.01f)));
  const std::size_t far_one = index(mesh.positions.push_back(Vec3f(0, 0, 3)));
  const GeodesicBalls balls = geodesic_balls(mesh);
  EXPECT_EQ(balls.members.of(near_one)[0], 100u);
  EXPECT_FLOAT_EQ(balls.distances_of(near_one)[0], 0.01f);
  EXPECT_THAT(balls.members.of(far_one), IsEmpty());
}

TEST(GeodesicBalls, renumbering_vertices_renumbers_the_balls_and_nothing_else) {
  const TriangleMesh mesh = potato(3);
  const auto order = shuffled(mesh.positions.size());
  const GeodesicBalls balls = geodesic_balls(mesh, 0.2f), other = geodesic_balls(renumbered(mesh, order), 0.2f);
  for (std::size_t v = 0; v < order.size(); ++v) {
    const auto expected = balls.members.of(order[v]), found = other.members.of(v);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_EQ(order[found[i]], expected[i]);
    EXPECT_TRUE(std::ranges::equal(other.distances_of(v), balls.distances_of(order[v])));
  }
}

TEST(GeodesicBalls, do_not_depend_on_the_number_of_threads) {
  const TriangleMesh mesh = shapes::merged(potato(4), shapes::shifted(potato(3), {0.4f, 0, 0}));
  const int before = threads();
  set_threads(1);
  const GeodesicBalls one = geodesic_balls(mesh);
  set_threads(3);
  const GeodesicBalls three = geodesic_balls(mesh);
  set_threads(before);
  EXPECT_EQ(one.members, three.members);
  EXPECT_EQ(one.distances, three.distances);
}

TEST(Evenly, takes_near_and_far_members) {
  GeodesicBalls balls;
  balls.members = {{0, 20, 23}, std::vector<std::uint32_t>(23)};
  std::iota(balls.members.members.begin(), balls.members.members.end(), 100u);
  const Neighbourhoods some = evenly(balls, 5);
  EXPECT_THAT(some.of(0), ElementsAre(102, 106, 110, 114, 118));
  EXPECT_THAT(some.of(1), ElementsAre(120, 121, 122));  // fewer than asked for: all
}

TEST(Drawn, gives_every_member_the_same_chance_once_per_row) {
  GeodesicBalls balls;
  balls.members = {{0, 20}, std::vector<std::uint32_t>(20)};
  std::iota(balls.members.members.begin(), balls.members.members.end(), 0u);
  Random random(1);
  std::vector<int> counts(20, 0);
  for (int i = 0; i < 4000; ++i) {
    const Neighbourhoods row = drawn(balls, 5, random);
    EXPECT_EQ(std::set<std::uint32_t>(row.members.begin(), row.members.end()).size(), 5u);
    EXPECT_TRUE(std::ranges::is_sorted(row.members));
    for (std::uint32_t u : row.members) ++counts[u];
  }
  for (int count : counts) EXPECT_NEAR(count, 1000, 140);  // binomial with deviation 27
}

}  // namespace
}  // namespace osteon::geometry
