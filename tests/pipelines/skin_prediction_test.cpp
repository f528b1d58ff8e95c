// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/skin_prediction.h"

#include <cmath>

#include "osteon/mesh/shapes.h"
#include "osteon/pipelines/rig_report.h"
#include "support/expect.h"

namespace osteon::pipelines {
namespace {

// hip with two children: bones hip-left, left (leaf), hip-right, right (leaf).
std::vector<Bone> fork() {
  Skeleton s;
  const JointId hip = s.add("hip", std::nullopt, {0, 0, 0});
  s.add("left", hip, {1, 0, 0});
  s.add("right", hip, {-1, 0, 0});
  return bones(s);
}

TEST(SkinPrediction, bones_give_their_weight_to_the_joint_they_start_at) {
  geometry::IndexMatrix nearest(2, 3);
  nearest << 0, 2, 1,  // hip-left, hip-right, left
      3, -1, -1;       // right; fewer bones than columns
  Matrix weights(2, 3);
  weights << 0.5f, 0.2f, 0.3f,  //
      1.0f, 0.0f, 0.0f;
  const auto list = fork();
  const Matrix joints = joint_weights(weights, nearest, list, 3);
  EXPECT_FLOAT_EQ(joints(0, 0), 0.7f);
  EXPECT_FLOAT_EQ(joints(0, static_cast<Eigen::Index>(index(list[1].start))), 0.3f);
  EXPECT_FLOAT_EQ(joints(1, static_cast<Eigen::Index>(index(list[3].start))), 1.0f);
  EXPECT_FLOAT_EQ(joints.sum(), 2.0f);
}

Skeleton of_joints(std::size_t count) {
  Skeleton s;
  for (std::size_t j = 0; j < count; ++j)
    s.add(std::to_string(j), j > 0 ? std::optional(static_cast<JointId>(j - 1)) : std::nullopt, {0, static_cast<float>(j), 0});
  return s;
}

TEST(SkinPrediction, every_vertex_of_the_original_gets_valid_weights_whatever_the_network_says) {
  const TriangleMesh mesh = shapes::merged(shapes::capsule(0.2f, 1.0f),
                                           shapes::transformed(shapes::icosphere(1, 0.1f), Transform(Eigen::Translation3f(2, 0, 0))));
  const auto working = geometry::make_working_mesh(mesh);
  const auto ring = geometry::one_ring(working.mesh);
  const auto rows = static_cast<Eigen::Index>(working.mesh.positions.size());
  Matrix raw = Matrix::Zero(rows, 3);
  validate(finish_weights(raw, working, ring, of_joints(3)), mesh.positions.size(), 3);
  raw.setConstant(NAN);
  validate(finish_weights(raw, working, ring, of_joints(3)), mesh.positions.size(), 3);
  raw.setConstant(1.0f);
  const SkinWeights equal = finish_weights(raw, working, ring, of_joints(3), {.max_influences = 2});
  validate(equal, mesh.positions.size(), 3);
  EXPECT_EQ(equal.max_influences(), 2u);
  raw.setZero();
  raw(rows / 2, 1) = 1e-30f;  // one vertex alone
  const SkinWeights one = finish_weights(raw, working, ring, of_joints(3));
  for (VertexId v : mesh.positions.ids()) EXPECT_EQ(one[v][0], (Influence{JointId{1}, 1.0f}));
}

TEST(SkinPrediction, weights_follow_the_surface_of_the_original) {
  const TriangleMesh mesh = shapes::capsule(0.1f, 1.0f, 48, 12);
  const auto working = geometry::make_working_mesh(mesh);
  Matrix raw = Matrix::Zero(static_cast<Eigen::Index>(working.mesh.positions.size()), 2);
  for (VertexId v : working.mesh.positions.ids())
    raw(static_cast<Eigen::Index>(index(v)), working.normalization.undo(working.mesh.positions[v]).y() > 0.5f ? 1 : 0) = 1.0f;
  const SkinWeights weights = finish_weights(raw, working, geometry::one_ring(working.mesh), of_joints(2));
  for (VertexId v : mesh.positions.ids())
    if (const float y = mesh.positions[v].y(); std::abs(y - 0.5f) > 0.1f) {
      EXPECT_EQ(weights[v][0], (Influence{y > 0.5f ? JointId{1} : JointId{0}, 1.0f}));
    }
}

TEST(RigReport, mirror_error_is_zero_for_mirrored_points_and_else_their_distance) {
  const Plane plane{Vec3f::UnitX(), 0.5f};
  EXPECT_FLOAT_EQ(mirror_error({{0, 1, 2}, {1, 1, 2}, {0.5f, 3, 0}}, plane), 0.0f);
  EXPECT_FLOAT_EQ(mirror_error({{0, 1, 2}, {1, 1.1f, 2}}, plane), 0.1f);
}

TEST(RigReport, covered_share_counts_rows_within_reach) {
  Matrix distances(3, 2);
  distances << 0.1f, 0.9f, 0.9f, 0.2f, 0.5f, 0.5f;
  EXPECT_FLOAT_EQ(covered_share(distances, 0.2f), 2.0f / 3.0f);
  EXPECT_EQ(covered_share(Matrix(0, 0), 0.2f), 0.0f);
}

TEST(Pooled, of_two_that_agree_is_what_they_say_but_sharper) {
  Matrix a(2, 3);
  a << 0.7f, 0.3f, 0.0f, 0.5f, 0.5f, 0.0f;
  const Matrix both = pooled(a, a, 0.3f);
  const float x = std::pow(0.7f, 1.2f), y = std::pow(0.3f, 1.2f);
  EXPECT_NEAR(both(0, 0), x / (x + y), 1e-5f);
  EXPECT_NEAR(both(0, 1), y / (x + y), 1e-5f);
  EXPECT_NEAR(both(1, 0), 0.5f, 1e-5f);
  EXPECT_NEAR(both(0, 2), 0.0f, 1e-6f);
}

TEST(Pooled, what_one_of_both_rules_out_is_nearly_out) {
  Matrix a(1, 3), b(1, 3);
  a << 0.5f, 0.5f, 0.0f;
  b << 0.5f, 0.0f, 0.5f;
  const Matrix both = pooled(a, b, 0.5f);
  EXPECT_NEAR(both.sum(), 1.0f, 1e-6f);
  EXPECT_EQ(both(0, 1), both(0, 2));
  EXPECT_GT(both(0, 0), 0.65f);  // their mean is 0.5, 0.25, 0.25
}

TEST(Pooled, is_the_same_for_columns_in_another_order_and_the_shares_the_other_way_round) {
  Matrix a(1, 3), b(1, 3);
  a << 0.6f, 0.3f, 0.1f;
  b << 0.2f, 0.2f, 0.6f;
  const Matrix both = pooled(a, b, 0.25f), other = pooled(b.rowwise().reverse(), a.rowwise().reverse(), 0.75f);
  EXPECT_LT((both - other.rowwise().reverse()).cwiseAbs().maxCoeff(), 1e-6f);
}

}  // namespace
}  // namespace osteon::pipelines
