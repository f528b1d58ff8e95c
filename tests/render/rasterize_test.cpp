// SPDX-License-Identifier: Apache-2.0
#include "osteon/render/rasterize.h"

#include <algorithm>
#include <numbers>

#include "osteon/base/parallel.h"
#include "osteon/base/random.h"
#include "osteon/mesh/shapes.h"
#include "osteon/render/camera.h"
#include "support/expect.h"

namespace osteon::render {
namespace {

std::size_t covered(const VisibilityBuffer& buffer) {
  return static_cast<std::size_t>(std::ranges::count_if(buffer.faces, [](std::uint32_t f) { return f != nothing; }));
}

TriangleMesh triangle(const Vec3f& a, const Vec3f& b, const Vec3f& c) {
  TriangleMesh mesh;
  for (const Vec3f& p : {a, b, c}) mesh.positions.push_back(p);
  mesh.faces.push_back({VertexId{0}, VertexId{1}, VertexId{2}});
  return mesh;
}

TEST(Rasterize, a_sphere_covers_the_area_of_its_disc) {
  const TriangleMesh sphere = shapes::icosphere(5);
  const Camera camera{Eigen::Matrix3f::Identity(), Vec3f::Zero(), {300, 300}, 250};
  const auto buffer = rasterize(project(sphere.positions, camera), sphere.faces, 600, 600);
  EXPECT_NEAR(static_cast<double>(covered(buffer)) / (std::numbers::pi * 250 * 250), 1.0, 0.002);
}

TEST(Rasterize, the_depth_of_a_sphere_is_that_of_its_surface) {
  const TriangleMesh sphere = shapes::icosphere(5);
  const Camera camera{Eigen::Matrix3f::Identity(), Vec3f::Zero(), {50, 50}, 40};
  const auto buffer = rasterize(project(sphere.positions, camera), sphere.faces, 100, 100);
  for (int x = 20; x < 80; ++x) {
    const float across = (static_cast<float>(x) + 0.5f - 50) / 40;
    EXPECT_NEAR(buffer.depths[buffer.index(x, 50)], std::sqrt(1 - across * across), 0.01f);
  }
}

TEST(Rasterize, the_nearer_face_is_seen_whatever_the_order) {
  TriangleMesh mesh = triangle({0, 0, 1}, {40, 0, 1}, {0, 40, 1});
  mesh = shapes::merged(mesh, triangle({0, 0, 2}, {40, 0, 2}, {0, 40, 2}));
  mesh = shapes::merged(mesh, triangle({0, 0, 0}, {40, 0, 0}, {0, 40, 0}));
  const auto buffer = rasterize(mesh.positions, mesh.faces, 40, 40);
  EXPECT_EQ(buffer.faces[buffer.index(10, 10)], 1u);
  EXPECT_EQ(buffer.depths[buffer.index(10, 10)], 2.0f);
}

TEST(Rasterize, triangles_of_a_fan_share_their_pixels_without_gap_or_overlap) {
  Random random(1);
  TriangleMesh fan;
  fan.positions.push_back({32.5f, 32.5f, 0});  // on a pixel's centre, so that many edges run through it
  constexpr int spokes = 16;
  for (int i = 0; i < spokes; ++i) {
    const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / spokes;
    fan.positions.push_back({32.5f + 30 * std::cos(angle), 32.5f + 30 * std::sin(angle), 0});
  }
  std::size_t separately = 0;
  for (std::uint32_t i = 0; i < spokes; ++i) {
    fan.faces.push_back({VertexId{0}, VertexId{1 + i}, VertexId{1 + (i + 1) % spokes}});
    separately += covered(rasterize(fan.positions, PerFace<Triangle>{fan.faces[FaceId{i}]}, 64, 64));
  }
  EXPECT_EQ(covered(rasterize(fan.positions, fan.faces, 64, 64)), separately);
  EXPECT_NEAR(static_cast<double>(separately), 0.5 * spokes * 900 * std::sin(2 * std::numbers::pi / spokes), 30);
}

TEST(Rasterize, both_sides_of_a_face_are_drawn) {
  const TriangleMesh front = triangle({0, 0, 0}, {0, 40, 0}, {40, 0, 0}), back = triangle({0, 0, 0}, {40, 0, 0}, {0, 40, 0});
  EXPECT_EQ(covered(rasterize(front.positions, front.faces, 40, 40)), covered(rasterize(back.positions, back.faces, 40, 40)));
}

TEST(Rasterize, what_is_outside_the_picture_or_far_away_is_left_out) {
  const TriangleMesh crossing = triangle({-1e5f, -1e5f, 0}, {1e5f, -1e5f, 0}, {0, 1e5f, 0});
  EXPECT_EQ(covered(rasterize(crossing.positions, crossing.faces, 30, 20)), 600u);
  const TriangleMesh far = triangle({-1e30f, 0, 0}, {1e30f, 0, 0}, {0, 1e30f, 0});
  EXPECT_EQ(covered(rasterize(far.positions, far.faces, 30, 20)), 0u);
}

TEST(Rasterize, one_and_two_threads_see_the_same) {
  const TriangleMesh sphere = shapes::icosphere(5);
  const auto corners = project(sphere.positions, {Eigen::Matrix3f::Identity(), Vec3f::Zero(), {100, 100}, 90});
  const int before = threads();
  set_threads(1);
  const auto one = rasterize(corners, sphere.faces, 200, 200);
  set_threads(2);
  const auto two = rasterize(corners, sphere.faces, 200, 200);
  set_threads(before);
  EXPECT_EQ(one.faces, two.faces);
  EXPECT_EQ(one.depths, two.depths);
}

}  // namespace
}  // namespace osteon::render
