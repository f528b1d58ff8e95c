// SPDX-License-Identifier: Apache-2.0
#include "osteon/skin/distance_weights.h"

#include "support/expect.h"

namespace osteon::skin {
namespace {

// hip with two children: bones hip-left, left (leaf), hip-right, right (leaf).
std::vector<Bone> fork() {
  Skeleton s;
  const JointId hip = s.add("hip", std::nullopt, {0, 0, 0});
  s.add("left", hip, {1, 0, 0});
  s.add("right", hip, {-1, 0, 0});
  return bones(s);
}

TEST(DistanceWeights, the_nearest_bone_has_the_largest_weight_and_rows_sum_to_one) {
  Matrix distances(2, 4);
  const auto list = fork();
  for (std::size_t b = 0; b < 4; ++b) distances(0, static_cast<Eigen::Index>(b)) = index(list[b].start) == 1 ? 0.1f : 0.4f;
  distances.row(1).setConstant(1e6f);
  const Matrix weights = distance_weights(distances, list, 3);
  EXPECT_GT(weights(0, 1), 0.9f);
  EXPECT_NEAR(weights.row(0).sum(), 1.0f, 1e-6f);
  for (int j = 0; j < 3; ++j) EXPECT_NEAR(weights(1, j), 1.0f / 3.0f, 1e-6f);  // the fork's two bones count once
}

TEST(DistanceWeights, a_vertex_on_a_bone_has_a_finite_share) {
  Matrix distances = Matrix::Constant(1, 4, 0.3f);
  distances(0, 0) = 0.0f;
  const Matrix weights = distance_weights(distances, fork(), 3);
  EXPECT_TRUE(weights.allFinite());
  EXPECT_GT(weights(0, 0), 0.99f);
}

}  // namespace
}  // namespace osteon::skin
