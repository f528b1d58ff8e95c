// SPDX-License-Identifier: Apache-2.0
#include "osteon/render/camera.h"

#include <cmath>

#include "osteon/base/parallel.h"

namespace osteon::render {

Vec3f Camera::project(const Vec3f& p) const {
  const Vec3f seen = axes * (p - target);
  return {centre.x() + pixels_per_metre * seen.x(), centre.y() - pixels_per_metre * seen.y(), seen.z()};
}

Eigen::Matrix3f view_axes(const View& view) {
  const Vec3f towards(std::sin(view.yaw) * std::cos(view.pitch), std::sin(view.pitch), std::cos(view.yaw) * std::cos(view.pitch));
  const Vec3f right(std::cos(view.yaw), 0, -std::sin(view.yaw));
  Eigen::Matrix3f axes;
  axes << right.transpose(), towards.cross(right).transpose(), towards.transpose();
  return axes;
}

PerVertex<Vec3f> project(const PerVertex<Vec3f>& positions, const Camera& camera) {
  PerVertex<Vec3f> out(positions.size());
  parallel_for(positions.size(), 16384, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) out.raw()[i] = camera.project(positions.raw()[i]);
  });
  return out;
}

Eigen::AlignedBox3f seen_bounds(const PerVertex<Vec3f>& positions, const View& view) {
  const Eigen::Matrix3f axes = view_axes(view);
  Eigen::AlignedBox3f box;
  for (const Vec3f& p : positions) box.extend(axes * p);
  return box;
}

}  // namespace osteon::render
