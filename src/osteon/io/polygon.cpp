// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/polygon.h"

#include <numeric>

namespace osteon::io {
namespace {

using Vec2d = Eigen::Vector2d;
using Corners = std::vector<std::uint32_t>;

// Beyond this many corners a polygon that is not convex is cut as a fan: cutting ears takes up to the cube of their number.
constexpr std::size_t kMostEarCorners = 512;

Eigen::Vector3d newell_normal(std::span<const Vec3f> corners) {
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  const Eigen::Vector3d origin = corners[0].cast<double>();
  for (std::size_t i = 0; i < corners.size(); ++i)
    normal += (corners[i].cast<double>() - origin).cross(corners[(i + 1) % corners.size()].cast<double>() - origin);
  return normal;
}

// The corners seen along the normal, which points to the viewer: counter-clockwise.
std::vector<Vec2d> flattened(std::span<const Vec3f> corners, const Eigen::Vector3d& normal) {
  int away = 0;
  normal.cwiseAbs().maxCoeff(&away);
  const int x = (away + 1) % 3, y = (away + 2) % 3;
  const double side = normal[away] < 0.0 ? -1.0 : 1.0;
  std::vector<Vec2d> out;
  for (const Vec3f& p : corners) out.emplace_back(side * static_cast<double>(p[x]), static_cast<double>(p[y]));
  return out;
}

// Twice the signed area of a triangle.
double turn(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

bool is_convex(const std::vector<Vec2d>& p) {
  for (std::size_t i = 0; i < p.size(); ++i)
    if (turn(p[i], p[(i + 1) % p.size()], p[(i + 2) % p.size()]) < 0.0) return false;
  return true;
}

bool inside(const Vec2d& a, const Vec2d& b, const Vec2d& c, const Vec2d& p) {
  return turn(a, b, p) >= 0.0 && turn(b, c, p) >= 0.0 && turn(c, a, p) >= 0.0;
}

// A corner is an ear if its triangle turns the right way and holds no other corner.
bool is_ear(const std::vector<Vec2d>& p, const Corners& left, std::size_t i) {
  const std::size_t n = left.size();
  const Vec2d &a = p[left[(i + n - 1) % n]], &b = p[left[i]], &c = p[left[(i + 1) % n]];
  if (turn(a, b, c) <= 0.0) return false;
  for (std::size_t k = 2; k + 1 < n; ++k) {
    const Vec2d& other = p[left[(i + k) % n]];
    if (other != a && other != b && other != c && inside(a, b, c, other)) return false;
  }
  return true;
}

void cut_ears(const std::vector<Vec2d>& p, std::vector<std::array<std::uint32_t, 3>>& triangles) {
  Corners left(p.size());
  std::iota(left.begin(), left.end(), 0u);
  std::size_t start = 0;
  while (left.size() > 3) {
    const std::size_t n = left.size();
    std::size_t ear = start % n;  // taken if none is found: the polygon crosses itself, or the rest is flat
    for (std::size_t k = 0; k < n; ++k)
      if (is_ear(p, left, (start + k) % n)) {
        ear = (start + k) % n;
        break;
      }
    triangles.push_back({left[(ear + n - 1) % n], left[ear], left[(ear + 1) % n]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
    start = ear;
  }
  triangles.push_back({left[0], left[1], left[2]});
}

}  // namespace

void triangulate(std::span<const Vec3f> corners, std::vector<std::array<std::uint32_t, 3>>& triangles) {
  if (corners.size() < 3) return;
  if (corners.size() == 3) {
    triangles.push_back({0, 1, 2});
    return;
  }
  const std::vector<Vec2d> flat = flattened(corners, newell_normal(corners));
  if (corners.size() <= kMostEarCorners && !is_convex(flat)) return cut_ears(flat, triangles);
  for (std::uint32_t k = 1; k + 1 < corners.size(); ++k) triangles.push_back({0, k, k + 1});
}

}  // namespace osteon::io
