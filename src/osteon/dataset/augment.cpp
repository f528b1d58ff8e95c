// SPDX-License-Identifier: Apache-2.0
#include "osteon/dataset/augment.h"

#include <cmath>
#include <numbers>

namespace osteon::dataset {
namespace {

Eigen::Matrix3f turn(float angle, const Vec3f& axis) { return Eigen::AngleAxisf(angle, axis).toRotationMatrix(); }

Eigen::Matrix3f random_linear(const AugmentOptions& options, Random& random) {
  Vec3f scale;
  for (float& s : scale) s = std::exp(random.uniform(-options.stretch, options.stretch));
  if (random.uniform() < options.mirror) scale.x() = -scale.x();
  float yaw = random.uniform(-options.yaw, options.yaw);
  if (random.uniform() < options.half_turn) yaw += std::numbers::pi_v<float>;
  if (random.uniform() < options.quarter_turn) yaw += 0.5f * std::numbers::pi_v<float>;
  const float about_x = random.uniform(-options.tilt, options.tilt), about_z = random.uniform(-options.tilt, options.tilt);
  return turn(about_x, Vec3f::UnitX()) * turn(about_z, Vec3f::UnitZ()) * turn(yaw, Vec3f::UnitY()) * scale.asDiagonal();
}

}  // namespace

Placement random_placement(std::span<const Vec3f> positions, const AugmentOptions& options, Random& random) {
  Placement placement;
  placement.linear = random_linear(options, random);
  Eigen::AlignedBox3f box;
  for (const Vec3f& p : positions) box.extend(placement.linear * p);
  const float scale = 1.0f / box.sizes().maxCoeff();
  placement.linear *= scale;
  placement.offset = -scale * Vec3f(box.center().x(), box.min().y(), box.center().z());
  placement.length_scale = std::cbrt(std::abs(placement.linear.determinant()));
  return placement;
}

}  // namespace osteon::dataset
