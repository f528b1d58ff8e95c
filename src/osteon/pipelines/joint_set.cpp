// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/joint_set.h"

#include <algorithm>

namespace osteon::pipelines {
namespace {

// Smaller index first where equal. Pre: not empty.
std::size_t nearest(const std::vector<Vec3f>& positions, const Vec3f& place) {
  const auto distance = [&](const Vec3f& p) { return (p - place).squaredNorm(); };
  return static_cast<std::size_t>(std::ranges::min_element(positions, {}, distance) - positions.begin());
}

}  // namespace

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

JointSet joint_set_of(std::span<const Vec3f> positions, const std::optional<Plane>& symmetry, float tolerance) {
  JointSet joints;
  if (symmetry) joints.frame = MirrorFrame::of(*symmetry);
  for (const Vec3f& p : positions) joints.positions.push_back(joints.frame.to(p));
  joints.partner.resize(positions.size());
  for (std::size_t j = 0; symmetry && j < joints.size(); ++j) {
    const Vec3f image = mirrored(joints.positions[j]);
    const std::size_t other = nearest(joints.positions, image);
    const bool mutual = nearest(joints.positions, mirrored(joints.positions[other])) == j;
    if (mutual && (joints.positions[other] - image).norm() <= tolerance) joints.partner[j] = other;
  }
  return joints;
}

}  // namespace osteon::pipelines
