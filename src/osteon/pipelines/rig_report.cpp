// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/rig_report.h"

#include <algorithm>
#include <limits>

namespace osteon::pipelines {

float mirror_error(const std::vector<Vec3f>& points, const Plane& plane) {
  double sum = 0.0;
  for (const Vec3f& p : points) {
    float least = std::numeric_limits<float>::infinity();
    for (const Vec3f& q : points) least = std::min(least, (plane.mirror(p) - q).norm());
    sum += static_cast<double>(least);
  }
  return static_cast<float>(sum / static_cast<double>(points.size()));
}

float covered_share(const Matrix& distances, float reach) {
  if (distances.size() == 0) return 0.0f;
  return (distances.rowwise().minCoeff().array() <= reach).cast<float>().mean();
}

}  // namespace osteon::pipelines
