// SPDX-License-Identifier: Apache-2.0
#include "osteon/metrics/connectivity_metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace osteon::metrics {
namespace {

// hip - knee - foot, and a head on the hip.
Skeleton reference() {
  Skeleton s;
  const JointId hip = s.add("hip", std::nullopt, {0, 1, 0});
  const JointId knee = s.add("knee", hip, {0, 0.5f, 0});
  s.add("foot", knee, {0, 0, 0});
  s.add("head", hip, {0, 2, 0});
  return s;
}

Matrix certain(const Skeleton& s) {
  Matrix p = Matrix::Zero(static_cast<Eigen::Index>(s.size()), static_cast<Eigen::Index>(s.size()));
  for (JointId j : s.names.ids())
    if (const auto parent = s.parents[j]) {
      const auto a = static_cast<Eigen::Index>(j), b = static_cast<Eigen::Index>(*parent);
      p(a, b) = p(b, a) = 1.0f;
    }
  return p;
}

TEST(CompareConnectivity, the_reference_itself_is_right_in_everything) {
  const Skeleton s = reference();
  const ConnectivityScores scores = compare_connectivity(certain(s), std::vector{0.7f, 0.1f, 0.1f, 0.1f}, s, s);
  for (const double share : {scores.accuracy, scores.precision, scores.recall, scores.bones, scores.likeliest_root, scores.root})
    EXPECT_EQ(share, 1.0);
  EXPECT_EQ(scores.tree_edit_distance, 0.0);
}

TEST(CompareConnectivity, counts_by_hand) {
  const Skeleton s = reference();
  Matrix p = certain(s);
  p(1, 2) = p(2, 1) = 0.4f;  // knee - foot is missed
  p(2, 3) = p(3, 2) = 0.6f;  // foot - head is invented
  Skeleton tree;             // rooted at the head, the foot hanging there too
  const JointId head = tree.add("head", std::nullopt, {0, 2, 0});
  const JointId hip = tree.add("hip", head, {0, 1, 0});
  tree.add("knee", hip, {0, 0.5f, 0});
  tree.add("foot", head, {0, 0, 0});
  const ConnectivityScores scores = compare_connectivity(p, std::vector{0.5f, 0.1f, 0.1f, 0.3f}, tree, s);
  EXPECT_DOUBLE_EQ(scores.accuracy, 4.0 / 6.0);
  EXPECT_DOUBLE_EQ(scores.precision, 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(scores.recall, 2.0 / 3.0);
  EXPECT_DOUBLE_EQ(scores.bones, 2.0 / 3.0);
  EXPECT_EQ(scores.likeliest_root, 1.0);
  EXPECT_EQ(scores.root, 0.0);
  EXPECT_GT(scores.tree_edit_distance, 0.0);
}

TEST(CompareConnectivity, of_one_joint_has_only_a_root) {
  Skeleton s;
  s.add("root", std::nullopt, Vec3f::Zero());
  const ConnectivityScores scores = compare_connectivity(Matrix::Zero(1, 1), std::vector{1.0f}, s, s);
  EXPECT_EQ(scores.root, 1.0);
  for (const double share : {scores.accuracy, scores.precision, scores.recall, scores.bones}) EXPECT_TRUE(std::isnan(share));
}

}  // namespace
}  // namespace osteon::metrics
