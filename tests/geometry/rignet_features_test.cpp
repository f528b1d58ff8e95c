// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/rignet_features.h"

#include <limits>

#include "osteon/mesh/shapes.h"
#include "support/expect.h"

namespace osteon::geometry {
namespace {

using testing::ElementsAre;

TEST(PairFeatures, hold_both_joints_their_distance_and_the_part_inside) {
  const VoxelGrid grid = voxelize(shapes::box({1, 1, 1}));
  const std::vector<Vec3f> joints{{0, 0, 0}, {0.2f, 0, 0}, {0, 1.0f, 0}};
  const Matrix f = pair_features(joints, grid);
  ASSERT_EQ(f.rows(), 3);
  ASSERT_EQ(f.cols(), 8);
  EXPECT_THAT(std::vector<float>(f.row(0).begin(), f.row(0).end()), ElementsAre(0, 0, 0, 0.2f, 0, 0, 0.2f, 1));
  EXPECT_FLOAT_EQ(f(1, 4), 1.0f);  // pair (0, 2)
  EXPECT_NEAR(f(1, 7), 0.5f, 0.011f);
  EXPECT_FLOAT_EQ(f(2, 0), 0.2f);  // pair (1, 2)
  EXPECT_FLOAT_EQ(f(2, 6), std::hypot(0.2f, 1.0f));
}

TEST(PairFeatures, of_less_than_two_joints_are_empty) {
  const VoxelGrid grid = voxelize(shapes::box({1, 1, 1}));
  EXPECT_EQ(pair_features({}, grid).rows(), 0);
  EXPECT_EQ(pair_features(std::vector<Vec3f>{{0, 0, 0}}, grid).rows(), 0);
}

TEST(Proximity, is_bounded_and_falls_with_distance) {
  EXPECT_FLOAT_EQ(proximity(0.0f), 5.0f);
  EXPECT_FLOAT_EQ(proximity(0.08f), 1.0f);
  EXPECT_LT(proximity(1.0f), 0.1f);
}

const std::vector<Segment> kBones{{{0, 0, 0}, {0, 1, 0}}, {{0, 1, 0}, {0, 2, 0}}, {{0, 2, 0}, {0, 2, 0}}};
const std::vector<std::uint8_t> kLeaf{0, 0, 1};

TEST(SkinInputs, list_the_nearest_bones_first) {
  const std::vector<Vec3f> positions{{1, 2, 3}, {4, 5, 6}};
  Matrix distances(2, 3);
  distances << 0.3f, 0.1f, 0.2f,  //
      0.5f, 0.5f, 0.5f;
  const SkinInputs in = skin_inputs(positions, kBones, kLeaf, distances, 2);
  EXPECT_EQ(in.nearest, (IndexMatrix(2, 2) << 1, 2, 0, 1).finished());
  ASSERT_EQ(in.features.cols(), 3 + 2 * 8);
  const Eigen::RowVectorXf first = in.features.row(0);
  EXPECT_THAT(std::vector<float>(first.begin(), first.end()),
              ElementsAre(1, 2, 3, 0, 1, 0, 0, 2, 0, proximity(0.1f), 0, 0, 2, 0, 0, 2, 0, proximity(0.2f), 1));
}

TEST(SkinInputs, pad_with_the_nearest_bone_and_say_so) {
  const std::vector<Vec3f> positions{{1, 2, 3}};
  Matrix distances(1, 3);
  distances << 0.3f, 0.1f, 0.2f;
  const SkinInputs in = skin_inputs(positions, kBones, kLeaf, distances);
  EXPECT_EQ(in.features.cols(), 43);
  EXPECT_EQ(in.nearest, (IndexMatrix(1, 5) << 1, 2, 0, -1, -1).finished());
  for (int slot : {3, 4}) EXPECT_EQ(in.features.middleCols(3 + slot * 8, 8), in.features.middleCols(3, 8));
}

TEST(SkinInputs, leave_out_bones_at_infinity) {
  Matrix distances(1, 3);
  distances << 0.3f, std::numeric_limits<float>::infinity(), 0.2f;
  const SkinInputs in = skin_inputs(std::vector<Vec3f>{{1, 2, 3}}, kBones, kLeaf, distances, 3);
  EXPECT_EQ(in.nearest, (IndexMatrix(1, 3) << 2, 0, -1).finished());
}

TEST(OneBonePerJoint, keeps_the_nearest_of_those_that_start_together) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Matrix distances(2, 4);
  distances << 0.1f, 0.2f, 0.3f, 0.4f,  //
      0.3f, 0.2f, 0.2f, 0.1f;
  const Matrix expected = (Matrix(2, 4) << 0.1f, kInfinity, kInfinity, 0.4f, kInfinity, 0.2f, kInfinity, 0.1f).finished();
  EXPECT_EQ(one_bone_per_joint(distances, std::vector<int>{0, 0, 0, 2}), expected);  // ties: the smaller index
}

TEST(SkinTargets, give_a_joints_weight_to_the_nearest_of_its_bones_alone) {
  // Bones 0 and 1 start at joint 0, bone 2 at joint 1, bone 3 at joint 2.
  const std::vector<int> starts{0, 0, 1, 2};
  Matrix weights(3, 3);
  weights << 0.6f, 0.4f, 0.0f,  //
      0.5f, 0.25f, 0.25f,       //
      0.0f, 0.0f, 1.0f;
  const IndexMatrix nearest = (IndexMatrix(3, 3) << 1, 0, 2, 2, 0, 1, 0, 2, -1).finished();
  const SkinTargets t = skin_targets(weights, starts, nearest);
  const Matrix expected = (Matrix(3, 3) << 0.6f, 0.0f, 0.4f, 0.25f / 0.75f, 0.5f / 0.75f, 0.0f, 0.0f, 0.0f, 0.0f).finished();
  EXPECT_TRUE(t.weights.isApprox(expected, 1e-6f));
  EXPECT_THAT(t.covered, ElementsAre(testing::FloatEq(1.0f), testing::FloatEq(0.75f), 0.0f));
}

}  // namespace
}  // namespace osteon::geometry
