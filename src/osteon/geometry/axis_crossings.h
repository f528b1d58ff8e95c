// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "osteon/base/types.h"

namespace osteon::geometry {

// The lines along one axis through the centres of a grid's cells, and where faces cross them. Corners are rounded to 1/1024 cell, so that
// edge tests are exact and a line through an edge or a corner crosses exactly one of the faces around it.
class AxisCrossings {
 public:
  explicit AxisCrossings(int axis) : axis_(axis), u_((axis + 1) % 3), v_((axis + 2) % 3) {}

  // Calls visit(iu, iv, at, sign) for every line that the face crosses: the line's cell along the two other axes (axis + 1, axis + 2,
  // cyclic), where along the axis, and +1 where a line in the direction of the axis enters through the face, -1 where it leaves. Corners
  // are in cells.
  template <class Visit>
  void visit(const std::array<Eigen::Array3f, 3>& corners, const Visit& visit) const {
    std::array<Point, 3> p;
    std::array<float, 3> depth;
    for (std::size_t k = 0; k < 3; ++k) {
      p[k] = {std::llround(corners[k][u_] * kUnit), std::llround(corners[k][v_] * kUnit)};
      depth[k] = corners[k][axis_];
    }
    const std::int64_t whole = area(p[0], p[1], p[2]);
    if (whole == 0) return;
    const bool leaves = whole > 0;  // the normal looks along the axis
    if (!leaves) {
      std::swap(p[1], p[2]);
      std::swap(depth[1], depth[2]);
    }
    const auto [low_u, high_u] = std::minmax({p[0].u, p[1].u, p[2].u});
    const auto [low_v, high_v] = std::minmax({p[0].v, p[1].v, p[2].v});
    for (int iu = first_line(low_u); iu <= last_line(high_u); ++iu)
      for (int iv = first_line(low_v); iv <= last_line(high_v); ++iv)
        if (const auto w = weights(p, {iu * kUnit + kUnit / 2, iv * kUnit + kUnit / 2}); w[0] >= 0.0)
          visit(iu, iv, w[0] * static_cast<double>(depth[0]) + w[1] * static_cast<double>(depth[1]) + w[2] * static_cast<double>(depth[2]),
                leaves ? -1 : 1);
  }

 private:
  static constexpr std::int64_t kUnit = 1024;
  struct Point {
    std::int64_t u, v;
  };

  // Twice the signed area of abp.
  static std::int64_t area(const Point& a, const Point& b, const Point& p) { return (b.u - a.u) * (p.v - a.v) - (b.v - a.v) * (p.u - a.u); }
  // Lines exactly on an edge belong to the face for which the edge runs up, or flat to the left.
  static bool owns(const Point& a, const Point& b) { return b.v > a.v || (b.v == a.v && b.u < a.u); }
  static int first_line(std::int64_t low) { return static_cast<int>((low - kUnit / 2 + kUnit - 1) / kUnit); }
  static int last_line(std::int64_t high) { return static_cast<int>((high - kUnit / 2) / kUnit); }

  // Barycentric weights of a line; the first is negative where it passes the face.
  static std::array<double, 3> weights(const std::array<Point, 3>& p, const Point& line) {
    std::array<std::int64_t, 3> w;  // opposite corner k
    for (std::size_t k = 0; k < 3; ++k) {
      const Point &a = p[(k + 1) % 3], &b = p[(k + 2) % 3];
      w[k] = area(a, b, line);
      if (w[k] < 0 || (w[k] == 0 && !owns(a, b))) return {-1.0, 0.0, 0.0};
    }
    const double whole = static_cast<double>(w[0] + w[1] + w[2]);
    return {static_cast<double>(w[0]) / whole, static_cast<double>(w[1]) / whole, static_cast<double>(w[2]) / whole};
  }

  int axis_, u_, v_;
};

}  // namespace osteon::geometry
