// SPDX-License-Identifier: Apache-2.0
#include "osteon/metrics/skin_metrics.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <span>

#include "osteon/base/random.h"

namespace osteon::metrics {
namespace {

constexpr float kInfluenceThreshold = 1e-4f;  // NeuroSkinning, sec. 5.1; RigNet follows it

struct Counts {
  std::size_t both = 0, predicted = 0, reference = 0;
  double l1 = 0.0;
};

float weight_of(std::span<const Influence> row, JointId joint) {
  const auto found = std::find_if(row.begin(), row.end(), [&](const Influence& i) { return i.joint == joint; });
  return found == row.end() ? 0.0f : found->weight;
}

void count_vertex(std::span<const Influence> predicted, std::span<const Influence> reference, Counts& counts) {
  for (const Influence& i : predicted) {
    const float other = weight_of(reference, i.joint);
    counts.predicted += i.weight > kInfluenceThreshold;
    counts.both += i.weight > kInfluenceThreshold && other > kInfluenceThreshold;
    counts.l1 += std::abs(static_cast<double>(i.weight) - static_cast<double>(other));
  }
  for (const Influence& i : reference) {
    counts.reference += i.weight > kInfluenceThreshold;
    if (weight_of(predicted, i.joint) == 0.0f) counts.l1 += static_cast<double>(i.weight);
  }
}

Vec3f deformed(const Vec3f& p, std::span<const Influence> row, const PerJoint<Transform>& transforms) {
  Vec3f out = Vec3f::Zero();
  for (const Influence& i : row) out += i.weight * (transforms[i.joint] * p);
  return out;
}

Quatf random_rotation(Random& random, const SkinMetricOptions& options) {
  Vec3f axis(random.normal(), 0.0f, 0.0f);
  axis.y() = random.normal();
  axis.z() = random.normal();
  const float angle = std::clamp(random.normal() * options.spread, -options.limit, options.limit);
  return Quatf(Eigen::AngleAxisf(angle, axis.stableNormalized()));
}

void add_deformation(const Rig& reference, const SkinWeights& predicted, const std::vector<Pose>& poses, SkinScores& scores) {
  const std::size_t vertices = reference.mesh.positions.size();
  for (const Pose& pose : poses) {
    const auto transforms = skinning_transforms(reference.skeleton, pose);
    double sum = 0.0, largest = 0.0;
    for (VertexId v : reference.mesh.positions.ids()) {
      const Vec3f& p = reference.mesh.positions[v];
      const double distance =
          static_cast<double>((deformed(p, predicted[v], transforms) - deformed(p, reference.weights[v], transforms)).norm());
      sum += distance;
      largest = std::max(largest, distance);
    }
    scores.mean_distance += sum / static_cast<double>(vertices * poses.size());
    scores.max_distance += largest / static_cast<double>(poses.size());
  }
}

double share(std::size_t part, std::size_t whole) { return whole == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(whole); }

}  // namespace

std::vector<Pose> random_poses(const Skeleton& skeleton, const SkinMetricOptions& options) {
  Random random(options.seed);
  std::vector<Pose> poses;
  for (int i = 0; i < options.poses; ++i) {
    Pose pose = Pose::rest(skeleton);
    for (JointId j : skeleton.names.ids())
      if (skeleton.parents[j]) pose.rotations[j] = random_rotation(random, options);
    poses.push_back(std::move(pose));
  }
  return poses;
}

SkinScores compare_weights(const Rig& reference, const SkinWeights& predicted, const SkinMetricOptions& options) {
  assert(predicted.size() == reference.weights.size());
  Counts counts;
  for (VertexId v : reference.mesh.positions.ids()) count_vertex(predicted[v], reference.weights[v], counts);
  SkinScores scores{.precision = share(counts.both, counts.predicted),
                    .recall = share(counts.both, counts.reference),
                    .l1 = counts.l1 / static_cast<double>(reference.weights.size()),
                    .mean_distance = 0.0,
                    .max_distance = 0.0};
  add_deformation(reference, predicted, random_poses(reference.skeleton, options), scores);
  return scores;
}

}  // namespace osteon::metrics
