// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

#include "osteon/base/types.h"

namespace osteon::geometry {

// A sum of weighted squared distances to planes and points, as a function of position: x'Ax + 2b'x + c.
// Garland and Heckbert, "Surface simplification using quadric error metrics", SIGGRAPH 1997, section 5. The point term makes A invertible:
// the idea of Trettner and Kobbelt, "Fast and robust QEF minimization using probabilistic quadrics", CGF 39(2), 2020.
struct Quadric {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;  // A
  Eigen::Vector3d b = Eigen::Vector3d::Zero();
  double c = 0;

  // weight * (distance of x from the plane through `point` with unit `normal`)^2
  static Quadric plane(const Eigen::Vector3d& normal, const Eigen::Vector3d& point, double weight) {
    const Eigen::Vector3d n = weight * normal;
    const double d = -normal.dot(point);
    return {n.x() * normal.x(), n.x() * normal.y(), n.x() * normal.z(), n.y() * normal.y(), n.y() * normal.z(), n.z() * normal.z(), n * d,
            weight * d * d};
  }

  // weight * |x - point|^2
  static Quadric point(const Eigen::Vector3d& point, double weight) {
    return {weight, 0, 0, weight, 0, weight, -weight * point, weight * point.squaredNorm()};
  }

  Quadric& operator+=(const Quadric& o) {
    xx += o.xx, xy += o.xy, xz += o.xz, yy += o.yy, yz += o.yz, zz += o.zz;
    b += o.b;
    c += o.c;
    return *this;
  }
  friend Quadric operator+(Quadric a, const Quadric& b) { return a += b; }

  double operator()(const Eigen::Vector3d& x) const {
    const Eigen::Vector3d ax(xx * x.x() + xy * x.y() + xz * x.z(), xy * x.x() + yy * x.y() + yz * x.z(),
                             xz * x.x() + yz * x.y() + zz * x.z());
    return std::max(0.0, x.dot(ax + 2 * b) + c);  // rounding may leave a little less than nothing
  }

  // Where the value is least; not finite when A is singular, which a point term prevents.
  Eigen::Vector3d minimum() const {
    const double c00 = yy * zz - yz * yz, c01 = xz * yz - xy * zz, c02 = xy * yz - xz * yy;
    const double c11 = xx * zz - xz * xz, c12 = xy * xz - xx * yz, c22 = xx * yy - xy * xy;
    const double scale = -1 / (xx * c00 + xy * c01 + xz * c02);
    return scale * Eigen::Vector3d(c00 * b.x() + c01 * b.y() + c02 * b.z(), c01 * b.x() + c11 * b.y() + c12 * b.z(),
                                   c02 * b.x() + c12 * b.y() + c22 * b.z());
  }
};

}  // namespace osteon::geometry
