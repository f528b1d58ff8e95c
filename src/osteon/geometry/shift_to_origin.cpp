// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/shift_to_origin.h"

#include <cmath>

namespace osteon::geometry {

Vec3f shift_to_origin(const TriangleMesh& mesh) {
  const Eigen::AlignedBox3f box = bounds(mesh);
  const float side = box.sizes().maxCoeff();
  if (!(side > 0.0f)) return Vec3f::Zero();
  const float unit = 8.0f * std::exp2(std::ceil(std::log2(side)));
  return -unit * (box.center() / unit).unaryExpr([](float units) { return std::trunc(units); });
}

}  // namespace osteon::geometry
