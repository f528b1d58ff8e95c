// SPDX-License-Identifier: Apache-2.0
#include "osteon/metrics/skin_metrics.h"

#include <numbers>

#include "osteon/mesh/shapes.h"
#include "support/expect.h"

namespace osteon::metrics {
namespace {

const JointId kRoot{0}, kTip{1};

// A capsule along y with a joint at its foot and one half way up; its upper half hangs on the tip, the rest on the root.
Rig capsule_rig() {
  Rig rig;
  rig.mesh = shapes::capsule(0.1f, 1.0f);
  rig.skeleton.add("root", std::nullopt, Vec3f::Zero());
  rig.skeleton.add("tip", kRoot, Vec3f(0, 0.5f, 0));
  for (const Vec3f& p : rig.mesh.positions) rig.weights.append(std::vector<Influence>{{p.y() > 0.5f ? kTip : kRoot, 1.0f}});
  return rig;
}

SkinWeights all_on(JointId joint, std::size_t vertices) {
  SkinWeights weights;
  for (std::size_t v = 0; v < vertices; ++v) weights.append(std::vector<Influence>{{joint, 1.0f}});
  return weights;
}

TEST(SkinMetrics, of_the_reference_itself_are_perfect) {
  const Rig rig = capsule_rig();
  const SkinScores scores = compare_weights(rig, rig.weights);
  EXPECT_EQ(scores.precision, 1.0);
  EXPECT_EQ(scores.recall, 1.0);
  EXPECT_EQ(scores.l1, 0.0);
  EXPECT_EQ(scores.mean_distance, 0.0);
  EXPECT_EQ(scores.max_distance, 0.0);
}

TEST(SkinMetrics, of_everything_on_the_wrong_joint_are_the_worst) {
  Rig rig = capsule_rig();
  rig.weights = all_on(kTip, rig.mesh.positions.size());
  const SkinScores scores = compare_weights(rig, all_on(kRoot, rig.mesh.positions.size()));
  EXPECT_EQ(scores.precision, 0.0);
  EXPECT_EQ(scores.recall, 0.0);
  EXPECT_EQ(scores.l1, 2.0);
  EXPECT_GT(scores.mean_distance, 0.0);
  EXPECT_GT(scores.max_distance, scores.mean_distance);
}

TEST(SkinMetrics, measure_a_spread_influence_in_closed_form) {
  Rig rig = capsule_rig();
  const std::size_t n = rig.mesh.positions.size();
  rig.weights = all_on(kRoot, n);
  SkinWeights spread;
  for (std::size_t v = 0; v < n; ++v) spread.append(std::vector<Influence>{{kRoot, 0.75f}, {kTip, 0.25f}});
  const SkinScores scores = compare_weights(rig, spread);
  EXPECT_NEAR(scores.precision, 0.5, 1e-9);
  EXPECT_NEAR(scores.recall, 1.0, 1e-9);
  EXPECT_NEAR(scores.l1, 0.5, 1e-6);
}

TEST(SkinMetrics, see_a_rigid_part_move_as_far_as_the_chord) {
  Rig rig;
  rig.mesh = shapes::capsule(0.1f, 1.0f);
  rig.skeleton = capsule_rig().skeleton;
  rig.weights = all_on(kTip, rig.mesh.positions.size());
  const SkinMetricOptions options;
  const auto poses = random_poses(rig.skeleton, options);
  double expected = 0.0;  // |R p - p| about the tip, summed by hand
  for (const Pose& pose : poses)
    for (const Vec3f& p : rig.mesh.positions) {
      const Vec3f arm = p - rig.skeleton.rest_positions[kTip];
      expected += static_cast<double>((pose.rotations[kTip] * arm - arm).norm());
    }
  expected /= static_cast<double>(poses.size() * rig.mesh.positions.size());
  EXPECT_NEAR(compare_weights(rig, all_on(kRoot, rig.mesh.positions.size())).mean_distance, expected, 1e-6);
}

TEST(RandomPoses, leave_the_root_and_stay_within_the_limit) {
  Skeleton skeleton;
  skeleton.add("root", std::nullopt, Vec3f::Zero());
  for (int j = 1; j < 200; ++j) skeleton.add(fmt::format("j{}", j), kRoot, Vec3f::UnitX());
  double squares = 0.0;
  std::size_t count = 0;
  for (const Pose& pose : random_poses(skeleton)) {
    EXPECT_EQ(pose.rotations[kRoot].angularDistance(Quatf::Identity()), 0.0f);
    for (const Quatf& q : pose.rotations) EXPECT_LE(q.angularDistance(Quatf::Identity()), std::numbers::pi_v<float> / 2.0f + 1e-4f);
    for (std::size_t j = 1; j < skeleton.size(); ++j, ++count)
      squares +=
          std::pow(static_cast<double>(pose.rotations[JointId{static_cast<std::uint16_t>(j)}].angularDistance(Quatf::Identity())), 2.0);
  }
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(count)) * 180.0 / std::numbers::pi, 30.0, 1.5);  // 1990 draws, 3 standard errors
}

}  // namespace
}  // namespace osteon::metrics
