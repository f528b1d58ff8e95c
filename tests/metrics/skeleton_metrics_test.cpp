// SPDX-License-Identifier: Apache-2.0
#include "osteon/metrics/skeleton_metrics.h"

#include "support/expect.h"

namespace osteon::metrics {
namespace {

JointId joint(int j) { return JointId{static_cast<std::uint16_t>(j)}; }

// Joints at (0,0,0), (0,0.1,0), ... in a row.
Skeleton chain(int n) {
  Skeleton skeleton;
  for (int j = 0; j < n; ++j)
    skeleton.add(fmt::format("j{}", j), j == 0 ? std::nullopt : std::optional(joint(j - 1)),
                 Vec3f(0.0f, 0.1f * static_cast<float>(j), 0.0f));
  return skeleton;
}

Skeleton shifted(Skeleton skeleton, const Vec3f& by) {
  for (Vec3f& p : skeleton.rest_positions) p += by;
  return skeleton;
}

PerJoint<float> tolerance(const Skeleton& skeleton, float value) { return PerJoint<float>(skeleton.size(), value); }

TEST(SkeletonMetrics, of_the_reference_itself_are_perfect) {
  const Skeleton s = chain(5);
  const SkeletonScores scores = compare_skeletons(s, s, tolerance(s, 0.01f));
  EXPECT_EQ(scores.iou, 1.0);
  EXPECT_EQ(scores.precision, 1.0);
  EXPECT_EQ(scores.recall, 1.0);
  EXPECT_EQ(scores.cd_j2j, 0.0);
  EXPECT_EQ(scores.cd_j2b, 0.0);
  EXPECT_EQ(scores.cd_b2b, 0.0);
  EXPECT_EQ(scores.tree_edit_distance, 0.0);
}

TEST(SkeletonMetrics, of_a_skeleton_moved_sideways_are_the_shift) {
  const Skeleton s = chain(5), moved = shifted(s, Vec3f(0.03f, 0, 0));
  const SkeletonScores scores = compare_skeletons(moved, s, tolerance(s, 0.04f));
  EXPECT_NEAR(scores.cd_j2j, 0.03, 1e-6);
  EXPECT_NEAR(scores.cd_j2b, 0.03, 1e-6);
  EXPECT_NEAR(scores.cd_b2b, 0.03, 1e-6);
  EXPECT_EQ(scores.iou, 1.0);
}

TEST(SkeletonMetrics, find_no_joint_at_exactly_the_tolerance) {
  const Skeleton s = chain(3), moved = shifted(s, Vec3f(0.25f, 0, 0));
  EXPECT_EQ(compare_skeletons(moved, s, tolerance(s, 0.25f)).iou, 0.0);
}

TEST(SkeletonMetrics, use_the_tolerance_of_the_reference_joint) {
  const Skeleton s = chain(4), moved = shifted(s, Vec3f(0.03f, 0, 0));
  PerJoint<float> tolerances = tolerance(s, 0.01f);
  tolerances[joint(2)] = 0.05f;
  const SkeletonScores scores = compare_skeletons(moved, s, tolerances);
  EXPECT_EQ(scores.precision, 0.25);
  EXPECT_EQ(scores.recall, 0.25);
}

TEST(SkeletonMetrics, count_two_predictions_at_one_joint_once) {
  const Skeleton s = chain(1);
  Skeleton twice = s;
  twice.add("again", joint(0), Vec3f(0.001f, 0, 0));
  const SkeletonScores scores = compare_skeletons(twice, s, tolerance(s, 0.01f));
  EXPECT_EQ(scores.precision, 0.5);
  EXPECT_EQ(scores.recall, 1.0);
  EXPECT_NEAR(scores.iou, 2.0 / 3.0, 1e-12);
  EXPECT_EQ(scores.tree_edit_distance, 1.0);
}

TEST(SkeletonMetrics, see_a_missing_end_joint) {
  const Skeleton s = chain(5), shorter = chain(4);
  const SkeletonScores scores = compare_skeletons(shorter, s, tolerance(s, 0.01f));
  EXPECT_EQ(scores.precision, 1.0);
  EXPECT_EQ(scores.recall, 0.8);
  EXPECT_NEAR(scores.cd_j2j, 0.5 * 0.1 / 5.0, 1e-7);  // one of five reference joints is 0.1 away
  EXPECT_NEAR(scores.cd_j2b, 0.5 * 0.1 / 5.0, 1e-7);
  EXPECT_EQ(scores.tree_edit_distance, 1.0);
}

TEST(SkeletonMetrics, do_not_depend_on_the_numbering_of_the_joints) {
  Skeleton a, b;  // one star, its arms added in two orders
  const Vec3f ends[] = {{0.3f, 0, 0}, {-0.3f, 0.1f, 0}, {0, 0.4f, 0.1f}};
  a.add("root", std::nullopt, Vec3f::Zero());
  b.add("root", std::nullopt, Vec3f::Zero());
  for (int k : {0, 1, 2}) a.add(fmt::format("arm{}", k), joint(0), ends[k]);
  for (int k : {2, 0, 1}) b.add(fmt::format("arm{}", k), joint(0), ends[k]);
  const Skeleton reference = shifted(chain(4), Vec3f(0.05f, 0.02f, 0.0f));
  const SkeletonScores of_a = compare_skeletons(a, reference, tolerance(reference, 0.1f));
  const SkeletonScores of_b = compare_skeletons(b, reference, tolerance(reference, 0.1f));
  EXPECT_EQ(of_a.iou, of_b.iou);
  EXPECT_NEAR(of_a.cd_j2j, of_b.cd_j2j, 1e-9);
  EXPECT_NEAR(of_a.cd_b2b, of_b.cd_b2b, 1e-9);
  EXPECT_EQ(of_a.tree_edit_distance, of_b.tree_edit_distance);
}

TEST(SkeletonMetrics, sample_bones_at_both_ends_and_every_step) {
  const auto samples = sample_bones(chain(2), 0.02f);  // one bone of length 0.1
  ASSERT_EQ(samples.size(), 6u);
  EXPECT_VEC3_NEAR(samples.front(), Vec3f::Zero(), 0.0f);
  EXPECT_VEC3_NEAR(samples.back(), Vec3f(0, 0.1f, 0), 0.0f);
  EXPECT_EQ(sample_bones(chain(1)).size(), 1u);
}

TEST(ConnectivityAccuracy, counts_each_wrong_bone_as_one_pair_too_many_and_one_missed) {
  Skeleton star;
  star.add("j0", std::nullopt, Vec3f::Zero());
  star.add("j1", joint(0), Vec3f::UnitX());
  star.add("j2", joint(0), Vec3f::UnitY());
  star.add("j3", joint(2), Vec3f::UnitZ());
  EXPECT_EQ(connectivity_accuracy(chain(4), chain(4)), 1.0);
  EXPECT_NEAR(connectivity_accuracy(star, chain(4)), 1.0 - 2.0 / 6.0, 1e-12);  // j2-j0 instead of j2-j1
}

TEST(ConnectivityAccuracy, refuses_other_joints) {
  EXPECT_EQ(test::error_of([] { connectivity_accuracy(chain(4), chain(3)); }),
            "skeletons of 4 and 3 joints do not have the same joint names");
}

}  // namespace
}  // namespace osteon::metrics
