// SPDX-License-Identifier: Apache-2.0
#include "osteon/metrics/skeleton_metrics.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <utility>

#include "osteon/base/error.h"
#include "osteon/metrics/assignment.h"
#include "osteon/metrics/tree_edit_distance.h"

namespace osteon::metrics {
namespace {

double mean_nearest_distance(std::span<const Vec3f> from, std::span<const Vec3f> to) {
  double sum = 0.0;
  for (const Vec3f& p : from) {
    float nearest = std::numeric_limits<float>::infinity();
    for (const Vec3f& q : to) nearest = std::min(nearest, (p - q).squaredNorm());
    sum += std::sqrt(static_cast<double>(nearest));
  }
  return sum / static_cast<double>(from.size());
}

Matrix joint_distances(const Skeleton& a, const Skeleton& b) {
  Matrix distances(static_cast<Eigen::Index>(a.size()), static_cast<Eigen::Index>(b.size()));
  for (JointId i : a.names.ids())
    for (JointId j : b.names.ids())
      distances(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = (a.rest_positions[i] - b.rest_positions[j]).norm();
  return distances;
}

// The bones as unordered pairs of joint names.
std::set<std::pair<std::string, std::string>> named_bones(const Skeleton& skeleton) {
  std::set<std::pair<std::string, std::string>> out;
  for (JointId j : skeleton.names.ids())
    if (skeleton.parents[j]) out.insert(std::minmax(skeleton.names[j], skeleton.names[*skeleton.parents[j]]));
  return out;
}

}  // namespace

std::vector<Vec3f> sample_bones(const Skeleton& skeleton, float step) {
  std::vector<Vec3f> samples;
  for (const Bone& bone : bones(skeleton)) {
    if (!bone.end) continue;  // the point at a leaf ends the bone before it
    const auto& [a, b] = bone.segment;
    const int steps = std::max(1, static_cast<int>(std::lround((b - a).norm() / step)));
    for (int i = 0; i <= steps; ++i) samples.push_back(a + (b - a) * (static_cast<float>(i) / static_cast<float>(steps)));
  }
  if (samples.empty()) samples.push_back(skeleton.rest_positions[JointId{0}]);
  return samples;
}

double chamfer_distance(std::span<const Vec3f> a, std::span<const Vec3f> b) {
  assert(!a.empty() && !b.empty());
  return 0.5 * (mean_nearest_distance(a, b) + mean_nearest_distance(b, a));
}

PerJoint<std::optional<JointId>> found_joints(const Skeleton& predicted, const Skeleton& reference, const PerJoint<float>& tolerances) {
  assert(tolerances.size() == reference.size());
  const Matrix distances = joint_distances(predicted, reference);
  const auto partners = assign(distances);
  PerJoint<std::optional<JointId>> found(predicted.size());
  for (JointId j : predicted.names.ids()) {
    const auto partner = partners[index(j)];
    if (!partner) continue;
    const JointId joint{static_cast<std::uint16_t>(*partner)};
    if (distances(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(*partner)) < tolerances[joint]) found[j] = joint;
  }
  return found;
}

SkeletonScores compare_skeletons(const Skeleton& predicted, const Skeleton& reference, const PerJoint<float>& tolerances) {
  const auto found = found_joints(predicted, reference, tolerances);
  const auto count = static_cast<double>(std::count_if(found.begin(), found.end(), [](const auto& j) { return j.has_value(); }));
  const auto np = static_cast<double>(predicted.size()), ng = static_cast<double>(reference.size());
  const std::vector<Vec3f>&joints_p = predicted.rest_positions.raw(), &joints_g = reference.rest_positions.raw();
  const std::vector<Vec3f> bones_p = sample_bones(predicted), bones_g = sample_bones(reference);
  return {.iou = 2.0 * count / (np + ng),
          .precision = count / np,
          .recall = count / ng,
          .cd_j2j = chamfer_distance(joints_p, joints_g),
          .cd_j2b = 0.5 * (mean_nearest_distance(joints_p, bones_g) + mean_nearest_distance(joints_g, bones_p)),
          .cd_b2b = chamfer_distance(bones_p, bones_g),
          .tree_edit_distance = static_cast<double>(tree_edit_distance(predicted, reference, found))};
}

double connectivity_accuracy(const Skeleton& predicted, const Skeleton& reference) {
  const std::set<std::string> names_p(predicted.names.begin(), predicted.names.end()),
      names_g(reference.names.begin(), reference.names.end());
  if (names_p != names_g) throw Error("skeletons of {} and {} joints do not have the same joint names", predicted.size(), reference.size());
  const auto bones_p = named_bones(predicted), bones_g = named_bones(reference);
  if (bones_p.empty()) return 1.0;
  const auto wrong = std::count_if(bones_p.begin(), bones_p.end(), [&](const auto& bone) { return !bones_g.contains(bone); });
  const auto pairs = static_cast<double>(reference.size() * (reference.size() - 1) / 2);
  return 1.0 - 2.0 * static_cast<double>(wrong) / pairs;  // both trees have equally many bones: each wrong one is also one missed
}

}  // namespace osteon::metrics
