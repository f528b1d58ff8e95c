// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/joint_set.h"

namespace osteon::pipelines {

MirrorFrame MirrorFrame::of(const Plane& plane) {
  Eigen::Index largest = 0;
  plane.normal.cwiseAbs().maxCoeff(&largest);
  const float sign = plane.normal[largest] < 0.0f ? -1.0f : 1.0f;
  const Vec3f normal = sign * plane.normal;
  MirrorFrame frame;
  frame.offset = sign * plane.offset;
  if (normal != Vec3f::UnitX()) frame.rotation = Quatf::FromTwoVectors(normal, Vec3f::UnitX()).toRotationMatrix();
  return frame;
}

}  // namespace osteon::pipelines
