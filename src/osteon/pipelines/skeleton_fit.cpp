// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/skeleton_fit.h"

#include <fmt/format.h>

#include <array>
#include <numbers>

#include "osteon/geometry/box_of_faces.h"
#include "osteon/geometry/surroundings.h"

namespace osteon::pipelines {
namespace {

constexpr double kMostInside = 0.9, kLeastSpan = 0.25, kMargin = 0.05;
constexpr std::array kScales{1.0, 0.01, 100.0, 0.001, 1000.0, 0.0254, 39.3700787};

Eigen::AlignedBox3d box_of(const Skeleton& skeleton, const Eigen::Affine3d& transform) {
  Eigen::AlignedBox3d box;
  for (const Vec3f& p : skeleton.rest_positions) box.extend(transform * p.cast<double>());
  return box;
}

bool fits(const Skeleton& skeleton, const Eigen::Affine3d& transform, const Eigen::AlignedBox3d& body) {
  const double longest = body.sizes().maxCoeff();
  const Eigen::Vector3d margin = Eigen::Vector3d::Constant(kMargin * longest);
  const Eigen::AlignedBox3d wide(body.min() - margin, body.max() + margin);
  std::size_t inside = 0;
  for (const Vec3f& p : skeleton.rest_positions) inside += wide.contains(transform * p.cast<double>());
  const bool spans = skeleton.size() == 1 || box_of(skeleton, transform).sizes().maxCoeff() >= kLeastSpan * longest;
  return spans && static_cast<double>(inside) >= kMostInside * static_cast<double>(skeleton.size());
}

}  // namespace

SkeletonFit fit_skeleton(const Skeleton& skeleton, const TriangleMesh& mesh) {
  const Eigen::AlignedBox3f b = geometry::box_of_faces(geometry::without(mesh, geometry::surroundings(mesh).has));
  const Eigen::AlignedBox3d body(b.min().cast<double>(), b.max().cast<double>());
  const std::array<std::pair<const char*, double>, 3> turns{
      {{"", 0.0}, {", z up taken for y up", -0.5 * std::numbers::pi}, {", y up taken for z up", 0.5 * std::numbers::pi}}};
  for (const auto& [turn, angle] : turns)
    for (const double scale : kScales) {
      const Eigen::Affine3d candidate(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitX()) * Eigen::Scaling(scale));
      if (!fits(skeleton, candidate, body)) continue;
      if (scale == 1.0 && angle == 0.0) return {};
      return {candidate, fmt::format("the skeleton did not fit the body: scaled by {}{}", scale, turn)};
    }
  const Eigen::AlignedBox3d joints = box_of(skeleton, Eigen::Affine3d::Identity());
  if (!(joints.sizes().y() > 0.0) || !(body.sizes().y() > 0.0))
    return {Eigen::Affine3d::Identity(), "the skeleton lies outside of the body; nothing was done about it"};
  const double scale = 0.9 * body.sizes().y() / joints.sizes().y();
  const Eigen::Vector3d from(joints.center().x(), joints.min().y(), joints.center().z());
  const Eigen::Vector3d to(body.center().x(), body.min().y(), body.center().z());
  return {Eigen::Affine3d(Eigen::Translation3d(to) * Eigen::Scaling(scale) * Eigen::Translation3d(-from)),
          fmt::format("the skeleton did not fit the body: scaled by {:.4g} to its height and moved to its middle; please check", scale)};
}

}  // namespace osteon::pipelines
