// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/tree_features.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "osteon/base/random.h"

namespace osteon::geometry {
namespace {

using Eigen::Index;

enum JointColumn {
  position = 0,
  from_image = 3,
  clearance,
  territory,
  way,
  to_nearest = 9,
  mean_distance,
  from_middle,
  count,
  degree,
  largest_part,
  eccentricity,
  height
};
enum PairColumn {
  offset = 0,
  distance = 3,
  by_first,
  by_second,
  inside,
  outside,
  rank,
  reverse_rank,
  lune,
  steps,
  is_step,
  mirrored,
  is_self
};

// A spine of three joints on x = 0, an arm to each side of the topmost.
const std::vector<Vec3f> cross{{0, 0, 0}, {0, 0.3f, 0}, {0, 0.5f, 0}, {0.3f, 0.5f, 0}, {-0.3f, 0.5f, 0}};

std::vector<Vec3f> mirrored_in_x(std::vector<Vec3f> points) {
  for (Vec3f& p : points) p.x() = -p.x();
  return points;
}

TreeFeatures features_of(const std::vector<Vec3f>& joints, const std::vector<Vec3f>& vertices, const Matrix& inside) {
  return tree_features({joints, mirrored_in_x(joints), vertices, inside});
}

TreeFeatures of_cross() {
  std::vector<Vec3f> vertices = cross;
  for (Vec3f& p : vertices) p.z() += 0.1f;
  return features_of(cross, vertices, Matrix::Ones(5, 5));
}

TEST(TreeFeatures, know_the_place_of_a_joint_in_the_shortest_tree) {
  const Matrix joints = of_cross().joints;
  ASSERT_EQ(joints.cols(), kTreeJointFeatures);
  EXPECT_EQ(joints.col(degree), (Eigen::VectorXf(5) << 1, 2, 3, 1, 1).finished());
  EXPECT_TRUE(joints.col(largest_part).isApprox((Eigen::VectorXf(5) << 4, 3, 2, 4, 4).finished() / 5.0f));
  EXPECT_TRUE(joints.col(eccentricity).isApprox((Eigen::VectorXf(5) << 3, 2, 2, 3, 3).finished() / 3.0f));
}

TEST(TreeFeatures, know_the_surface_around_a_joint) {
  const Matrix joints = of_cross().joints;
  EXPECT_TRUE(joints.col(clearance).isApproxToConstant(0.1f));
  EXPECT_TRUE(joints.col(territory).isApproxToConstant(1.0f));  // each has one vertex of five
  EXPECT_TRUE(joints.col(way + 2).isApproxToConstant(0.1f));
  EXPECT_NEAR(joints(3, from_image), 0.6f, 1e-6f);
  EXPECT_NEAR(joints(1, from_image), 0.0f, 1e-6f);
}

TEST(TreeFeatures, compare_a_pair_with_all_others) {
  const Matrix pairs = of_cross().pairs;
  ASSERT_EQ(pairs.cols(), kTreePairFeatures);
  const auto row = [&](Index i, Index j) { return pairs.row(i * 5 + j); };
  EXPECT_FLOAT_EQ(row(0, 1)(distance), 0.3f);
  EXPECT_FLOAT_EQ(row(0, 1)(rank), 1.0f);          // joint 1 is the nearest to joint 0
  EXPECT_FLOAT_EQ(row(0, 1)(reverse_rank), 0.5f);  // joint 2 is nearer to joint 1
  EXPECT_FLOAT_EQ(row(0, 2)(lune), 0.5f);          // joint 1 lies between them
  EXPECT_FLOAT_EQ(row(0, 1)(lune), 1.0f);
  EXPECT_FLOAT_EQ(row(0, 3)(steps), 1 / 3.0f);
  EXPECT_FLOAT_EQ(row(2, 3)(is_step), 1.0f);
  EXPECT_FLOAT_EQ(row(3, 4)(mirrored), 1.0f);
  EXPECT_LT(row(3, 2)(mirrored), 1e-3f);
  for (Index i = 0; i < 5; ++i)
    for (Index j = 0; j < 5; ++j) EXPECT_EQ(row(i, j)(is_self), i == j ? 1.0f : 0.0f);
}

TEST(TreeFeatures, go_round_what_is_outside) {
  const std::vector<Vec3f> triangle{{0, 0, 0}, {0.3f, 0, 0}, {0.15f, 0.3f, 0}};
  Matrix inside_all = Matrix::Ones(3, 3), gap = inside_all;
  gap(0, 1) = gap(1, 0) = 0.2f;  // the shortest side
  const auto joined = [&](const Matrix& inside) { return features_of(triangle, triangle, inside).pairs(0 * 3 + 1, is_step); };
  EXPECT_EQ(joined(inside_all), 1.0f);
  EXPECT_EQ(joined(gap), 0.0f);
  EXPECT_NEAR(features_of(triangle, triangle, gap).pairs(0 * 3 + 1, outside), 0.3f * 0.8f, 1e-6f);
}

TEST(TreeFeatures, follow_joints_in_another_order) {
  Random random(3);
  std::vector<Vec3f> joints, vertices;
  for (int i = 0; i < 12; ++i) joints.emplace_back(random.uniform(), random.uniform(), random.uniform());
  for (int i = 0; i < 200; ++i) vertices.emplace_back(random.uniform(), random.uniform(), random.uniform());
  const Matrix inside = Matrix::Ones(12, 12);
  std::vector<std::size_t> order(12);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::rotate(order, order.begin() + 5);
  std::vector<Vec3f> other;
  for (const std::size_t i : order) other.push_back(joints[i]);
  const TreeFeatures a = features_of(joints, vertices, inside), b = features_of(other, vertices, inside);
  for (Index i = 0; i < 12; ++i) {
    const auto from = static_cast<Index>(order[static_cast<std::size_t>(i)]);
    EXPECT_TRUE(b.joints.row(i).isApprox(a.joints.row(from), 1e-5f));
    for (Index j = 0; j < 12; ++j)
      EXPECT_TRUE(b.pairs.row(i * 12 + j).isApprox(a.pairs.row(from * 12 + static_cast<Index>(order[static_cast<std::size_t>(j)])), 1e-5f));
  }
}

TEST(TreeFeatures, are_finite_for_a_single_joint_and_for_joints_at_one_place) {
  for (const std::size_t n : {1u, 3u}) {
    const std::vector<Vec3f> joints(n, Vec3f(0.1f, 0.2f, 0.3f));
    const auto size = static_cast<Index>(n);
    const TreeFeatures features = features_of(joints, {{0, 0, 0}}, Matrix::Ones(size, size));
    EXPECT_TRUE(features.joints.allFinite());
    EXPECT_TRUE(features.pairs.allFinite());
  }
}

}  // namespace
}  // namespace osteon::geometry
