// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/polygon.h"

#include <gtest/gtest.h>

#include <cmath>

namespace osteon::io {
namespace {

using Triangles = std::vector<std::array<std::uint32_t, 3>>;

Triangles cut(const std::vector<Vec3f>& corners) {
  Triangles triangles;
  triangulate(corners, triangles);
  return triangles;
}

// Sum of the triangles' area vectors, and of their lengths: equal when none is flipped or overlaps another.
std::pair<Vec3f, float> areas(const std::vector<Vec3f>& p, const Triangles& triangles) {
  Vec3f sum = Vec3f::Zero();
  float total = 0.0f;
  for (const auto& [a, b, c] : triangles) {
    const Vec3f area = 0.5f * (p[b] - p[a]).cross(p[c] - p[a]);
    sum += area;
    total += area.norm();
  }
  return {sum, total};
}

// A polygon of n corners in the plane z = 0 whose radius swings: concave, star-shaped.
std::vector<Vec3f> star(int n) {
  std::vector<Vec3f> corners;
  for (int i = 0; i < n; ++i) {
    const float angle = 2.0f * static_cast<float>(M_PI) * static_cast<float>(i) / static_cast<float>(n), radius = i % 2 == 0 ? 1.0f : 0.3f;
    corners.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0.0f);
  }
  return corners;
}

TEST(Polygon, convex_polygons_are_covered_once) {
  const std::vector<Vec3f> pentagon{{0, 0, 0}, {2, 0, 0}, {3, 1, 0}, {1, 3, 0}, {-1, 1, 0}};
  const auto triangles = cut(pentagon);
  EXPECT_EQ(triangles.size(), 3u);
  const auto [sum, total] = areas(pentagon, triangles);
  EXPECT_NEAR(sum.z(), total, 1e-6f);
}

TEST(Polygon, a_dart_is_cut_at_its_dent) {
  const std::vector<Vec3f> dart{{0, 0, 0}, {4, 0, 0}, {1, 1, 0}, {0, 4, 0}};  // the dent is corner 2
  const auto [sum, total] = areas(dart, cut(dart));
  EXPECT_NEAR(sum.z(), 4.0f, 1e-5f);
  EXPECT_NEAR(total, 4.0f, 1e-5f);
}

TEST(Polygon, concave_polygons_are_covered_once_whatever_way_they_face) {
  for (const int n : {6, 10, 40, 200})
    for (const auto& axis : {Vec3f(1, 0, 0), Vec3f(0, 1, 0), Vec3f(1, -2, 0.5f)}) {
      std::vector<Vec3f> corners = star(n);
      for (Vec3f& p : corners) p = Eigen::AngleAxisf(2.1f, axis.normalized()) * p;
      const auto triangles = cut(corners);
      EXPECT_EQ(triangles.size(), static_cast<std::size_t>(n - 2));
      const auto [sum, total] = areas(corners, triangles);
      EXPECT_NEAR(sum.norm(), total, 1e-4f * total);
      EXPECT_NEAR(total, 0.5f * static_cast<float>(n) * 0.3f * std::sin(2.0f * static_cast<float>(M_PI) / static_cast<float>(n)), 1e-3f);
    }
}

TEST(Polygon, clockwise_polygons_stay_clockwise) {
  std::vector<Vec3f> corners = star(10);
  std::reverse(corners.begin(), corners.end());
  const auto [sum, total] = areas(corners, cut(corners));
  EXPECT_NEAR(sum.z(), -total, 1e-5f);
}

TEST(Polygon, flat_and_crossing_polygons_give_as_many_triangles) {
  EXPECT_EQ(cut(std::vector<Vec3f>(7, Vec3f(1, 1, 1))).size(), 5u);
  EXPECT_EQ(cut({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {1.5f, 0, 0}}).size(), 3u);
  EXPECT_EQ(cut({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}, {0.5f, 2, 0}}).size(), 3u);
  EXPECT_TRUE(cut({{0, 0, 0}, {1, 1, 0}}).empty());
}

}  // namespace
}  // namespace osteon::io
