// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/bvh.h"

#include <cmath>

#include "osteon/base/random.h"
#include "osteon/mesh/shapes.h"
#include "support/expect.h"

namespace osteon::geometry {
namespace {

Vec3f random_direction(Random& random) {
  const float x = random.normal(), y = random.normal(), z = random.normal();
  return Vec3f(x, y, z).normalized();
}

// Random triangles, every tenth without area.
TriangleMesh soup(std::size_t faces, Random& random) {
  TriangleMesh mesh;
  for (std::size_t f = 0; f < faces; ++f) {
    Triangle t;
    const Vec3f centre = random_direction(random);
    for (std::size_t k = 0; k < 3; ++k) t[k] = mesh.positions.push_back(centre + 0.2f * random_direction(random));
    if (f % 10 == 0) t[2] = t[1];
    mesh.faces.push_back(t);
  }
  return mesh;
}

TEST(ClosestBarycentric, agrees_with_projections_onto_every_feature) {
  const Vec3f a(0, 0, 0), b(1, 0, 0), c(0, 1, 0);
  EXPECT_EQ(closest_barycentric({-1, -1, 2}, a, b, c), Vec3f(1, 0, 0));
  EXPECT_EQ(closest_barycentric({2, 0, 1}, a, b, c), Vec3f(0, 1, 0));
  EXPECT_EQ(closest_barycentric({0, 3, 0}, a, b, c), Vec3f(0, 0, 1));
  EXPECT_VEC3_NEAR(closest_barycentric({0.5f, -1, 0}, a, b, c), Vec3f(0.5f, 0.5f, 0), 1e-6f);
  EXPECT_VEC3_NEAR(closest_barycentric({1, 1, 5}, a, b, c), Vec3f(0, 0.5f, 0.5f), 1e-6f);
  EXPECT_VEC3_NEAR(closest_barycentric({0.25f, 0.25f, -7}, a, b, c), Vec3f(0.5f, 0.25f, 0.25f), 1e-6f);
}

TEST(ClosestBarycentric, takes_degenerate_triangles_for_segments_and_points) {
  const Vec3f a(0, 0, 0), b(2, 0, 0);
  EXPECT_VEC3_NEAR(closest_barycentric({0.5f, 1, 0}, a, b, b), Vec3f(0.75f, 0.25f, 0), 1e-6f);
  EXPECT_EQ(closest_barycentric({0.5f, 1, 0}, a, a, a).sum(), 1.0f);
}

TEST(Bvh, closest_point_equals_the_search_over_all_faces) {
  Random random(1);
  const TriangleMesh mesh = soup(700, random);
  const Bvh bvh(mesh);
  for (int i = 0; i < 300; ++i) {
    const Vec3f p = 1.5f * random.uniform() * random_direction(random);
    float best = 1e9f;
    for (const auto& [a, b, c] : mesh.faces) {
      const Vec3f w = closest_barycentric(p, mesh.positions[a], mesh.positions[b], mesh.positions[c]);
      best = std::min(best, (w.x() * mesh.positions[a] + w.y() * mesh.positions[b] + w.z() * mesh.positions[c] - p).norm());
    }
    const ClosestPoint found = bvh.closest_point(p);
    EXPECT_EQ(found.distance, best);
    EXPECT_FLOAT_EQ((found.position - p).norm(), found.distance);
    const auto [a, b, c] = mesh.faces[found.face];
    EXPECT_VEC3_NEAR(
        found.position,
        found.barycentric.x() * mesh.positions[a] + found.barycentric.y() * mesh.positions[b] + found.barycentric.z() * mesh.positions[c],
        1e-6f);
  }
}

TEST(Bvh, first_hit_equals_the_search_over_all_faces) {
  Random random(2);
  const TriangleMesh mesh = soup(700, random);
  const Bvh whole(mesh);
  std::vector<Bvh> single;
  for (const Triangle& t : mesh.faces) single.emplace_back(TriangleMesh{mesh.positions, {t}});
  for (int i = 0; i < 200; ++i) {
    const Vec3f origin = 0.5f * random_direction(random), direction = random_direction(random);
    std::optional<RayHit> best;
    for (FaceId f : mesh.faces.ids())
      if (const auto hit = single[index(f)].first_hit(origin, direction); hit && (!best || hit->distance < best->distance))
        best = RayHit{f, hit->distance};
    const auto hit = whole.first_hit(origin, direction);
    ASSERT_EQ(hit.has_value(), best.has_value());
    if (!hit) continue;
    EXPECT_EQ(hit->face, best->face);
    EXPECT_EQ(hit->distance, best->distance);
    EXPECT_TRUE(whole.blocked({origin, origin + 1.01f * hit->distance * direction}));
    EXPECT_FALSE(whole.blocked({origin, origin + 0.99f * hit->distance * direction}));
    EXPECT_FALSE(whole.first_hit(origin, direction, 0.99f * hit->distance));
  }
}

TEST(Bvh, no_ray_leaves_a_closed_mesh_through_an_edge_or_a_corner) {
  const TriangleMesh sphere = shapes::icosphere(3);
  const Bvh bvh(sphere);
  for (const Triangle& t : sphere.faces)
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3f &a = sphere.positions[t[k]], &b = sphere.positions[t[(k + 1) % 3]];
      for (float s : {0.0f, 0.3f, 0.5f}) {
        const Vec3f target = (1 - s) * a + s * b;
        const auto hit = bvh.first_hit(Vec3f::Zero(), target.normalized());
        ASSERT_TRUE(hit);
        EXPECT_NEAR(hit->distance, target.norm(), 1e-5f);
      }
    }
}

TEST(Bvh, rays_along_an_axis_in_the_plane_of_a_box_side_are_not_lost) {
  const TriangleMesh mesh =
      shapes::merged(shapes::box({2, 2, 2}), shapes::transformed(shapes::box({2, 2, 2}), Transform(Eigen::Translation3f(0, 2, 0))));
  const auto hit = Bvh(mesh).first_hit({-5, 1, 0.25f}, {1, 0, 0});  // along the seam between the two boxes
  ASSERT_TRUE(hit);
  EXPECT_FLOAT_EQ(hit->distance, 4);
}

TEST(Bvh, of_equal_answers_the_smallest_face_is_given) {
  TriangleMesh mesh = shapes::sheet(1, 1);
  for (int copy = 0; copy < 5; ++copy)
    for (const Triangle& t : shapes::sheet(1, 1).faces) mesh.faces.push_back(t);
  const Bvh bvh(mesh);
  EXPECT_EQ(bvh.first_hit({0.5f, 0.5f, 1}, {0, 0, -1})->face, FaceId{0});  // on the diagonal of all
  EXPECT_EQ(bvh.closest_point({0.5f, 0.5f, 1}).face, FaceId{0});
  EXPECT_EQ(bvh.closest_point({0.1f, 0.9f, 1}).face, FaceId{1});
}

TEST(Bvh, a_point_too_far_away_for_the_square_of_its_distance_has_a_nearest_face_all_the_same) {
  for (const float far : {1e25f, -3e38f}) {
    const ClosestPoint nearest = Bvh(shapes::icosphere(2)).closest_point({far, 0, far});
    EXPECT_EQ(nearest.face, FaceId{0});
    EXPECT_NEAR(nearest.barycentric.sum(), 1, 1e-6f);
  }
}

TEST(Bvh, a_mesh_without_faces_is_never_hit) {
  TriangleMesh mesh;
  mesh.positions = {Vec3f(0, 0, 0)};
  EXPECT_FALSE(Bvh(mesh).first_hit({0, 0, -1}, {0, 0, 1}));
  EXPECT_FALSE(Bvh(mesh).blocked({Vec3f(0, 0, -1), Vec3f(0, 0, 1)}));
}

TEST(Bvh, faces_nearer_to_each_other_than_a_float_can_divide_by_have_a_nearest_one) {
  TriangleMesh mesh = shapes::icosphere(3);
  for (Vec3f& p : mesh.positions) p *= 1e-39f;
  EXPECT_NEAR(Bvh(mesh).closest_point({1, 0, 0}).barycentric.sum(), 1, 1e-6f);
}

TEST(Bvh, many_faces_at_one_place_do_not_overflow) {
  TriangleMesh mesh = shapes::sheet(1, 1);
  for (int copy = 0; copy < 12; ++copy) {
    const auto faces = mesh.faces;
    for (const Triangle& t : faces) mesh.faces.push_back(t);
  }
  EXPECT_EQ(Bvh(mesh).closest_point({0.9f, 0.1f, 1}).face, FaceId{0});
}

}  // namespace
}  // namespace osteon::geometry
