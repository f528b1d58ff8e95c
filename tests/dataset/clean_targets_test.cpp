// SPDX-License-Identifier: Apache-2.0
#include "osteon/dataset/clean_targets.h"

#include "osteon/mesh/shapes.h"
#include "support/expect.h"

namespace osteon::dataset {
namespace {

JointId joint(int j) { return JointId{static_cast<std::uint16_t>(j)}; }

TEST(MergeCoincidentJoints, keeps_a_skeleton_of_separate_joints) {
  Skeleton s;
  s.add("a", std::nullopt, Vec3f::Zero());
  s.add("b", joint(0), Vec3f::UnitY());
  const MergedSkeleton merged = merge_coincident_joints(s, 1e-3f);
  EXPECT_EQ(merged.skeleton.names, s.names);
  EXPECT_EQ(merged.from_original, (PerJoint<JointId>{joint(0), joint(1)}));
}

TEST(MergeCoincidentJoints, makes_a_stacked_chain_one_joint_and_hands_on_its_children) {
  Skeleton s;
  s.add("root", std::nullopt, Vec3f::Zero());
  s.add("control", joint(0), Vec3f(0, 1e-4f, 0));
  s.add("offset", joint(1), Vec3f(0, 2e-4f, 0));
  s.add("tip", joint(2), Vec3f::UnitY());
  const MergedSkeleton merged = merge_coincident_joints(s, 1e-3f);
  EXPECT_EQ(merged.skeleton.names, (PerJoint<std::string>{"root", "tip"}));
  EXPECT_EQ(merged.skeleton.parents[joint(1)], joint(0));
  EXPECT_EQ(merged.from_original, (PerJoint<JointId>{joint(0), joint(0), joint(0), joint(1)}));
  validate(merged.skeleton);
}

TEST(MergeCoincidentJoints, merges_siblings_but_not_cousins_at_one_place) {
  Skeleton s;
  s.add("root", std::nullopt, Vec3f::Zero());
  s.add("l", joint(0), Vec3f::UnitX());
  s.add("l_twist", joint(0), Vec3f::UnitX());
  s.add("r", joint(0), -Vec3f::UnitX());
  s.add("l_hand", joint(1), Vec3f::UnitY());
  s.add("r_hand", joint(3), Vec3f::UnitY());
  EXPECT_EQ(merge_coincident_joints(s, 1e-3f).skeleton.names, (PerJoint<std::string>{"root", "l", "r", "l_hand", "r_hand"}));
}

TEST(WeightsAt, are_the_vertex_weights_at_the_vertices_and_linear_between) {
  const TriangleMesh mesh = shapes::sheet(1, 1);
  SkinWeights weights;
  for (const Vec3f& p : mesh.positions) weights.append(std::vector<Influence>{{joint(0), 1.0f - p.x()}, {joint(1), p.x()}});
  const std::vector<Vec3f> points{{0, 0, 0}, {1, 1, 0}, {0.25f, 0.5f, 0.1f}};
  const SkinWeights at = weights_at(points, mesh, weights, {joint(0), joint(1)});
  EXPECT_EQ(at[VertexId{0}].size(), 1u);
  EXPECT_EQ(at[VertexId{1}].front(), (Influence{joint(1), 1.0f}));
  ASSERT_EQ(at[VertexId{2}].size(), 2u);
  EXPECT_NEAR(at[VertexId{2}][0].weight, 0.75f, 1e-6f);
  EXPECT_NEAR(at[VertexId{2}][1].weight, 0.25f, 1e-6f);
}

TEST(WeightsAt, add_up_for_merged_joints) {
  const TriangleMesh mesh = shapes::sheet(1, 1);
  SkinWeights weights;
  for (std::size_t v = 0; v < mesh.positions.size(); ++v) weights.append(std::vector<Influence>{{joint(0), 0.5f}, {joint(1), 0.5f}});
  const SkinWeights at = weights_at(std::vector<Vec3f>{{0.5f, 0.5f, 0}}, mesh, weights, {joint(0), joint(0)});
  ASSERT_EQ(at[VertexId{0}].size(), 1u);
  EXPECT_EQ(at[VertexId{0}].front(), (Influence{joint(0), 1.0f}));
}

}  // namespace
}  // namespace osteon::dataset
