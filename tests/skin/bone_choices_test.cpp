// SPDX-License-Identifier: Apache-2.0
#include "osteon/skin/bone_choices.h"

#include <set>

#include "osteon/geometry/cleanup.h"
#include "osteon/skin/neuro_features.h"
#include "skin/touching.h"
#include "support/expect.h"

namespace osteon::skin {
namespace {

JointId joint_of(const BoneChoices& choices, Eigen::Index row, Eigen::Index k) {
  return static_cast<JointId>(choices.bones.starts[static_cast<std::size_t>(choices.nearest(row, k))]);
}

TEST(BoneChoices, every_vertex_has_joints_each_once_nearest_first_and_shares_that_sum_to_one) {
  const test::Bound hand = test::touching_capsules(5);
  const TriangleMesh mesh = geometry::clean(hand.mesh).mesh;
  const BoneChoices choices = bone_choices(mesh, hand.skeleton);
  ASSERT_EQ(choices.nearest.rows(), static_cast<Eigen::Index>(mesh.positions.size()));
  for (Eigen::Index v = 0; v < choices.nearest.rows(); ++v) {
    ASSERT_GE(choices.nearest(v, 0), 0);
    std::set<JointId> joints;
    Eigen::Index count = 0;
    for (; count < choices.nearest.cols() && choices.nearest(v, count) >= 0; ++count) {
      joints.insert(joint_of(choices, v, count));
      if (count > 0) EXPECT_LE(choices.distances(v, count - 1), choices.distances(v, count));
    }
    EXPECT_EQ(static_cast<Eigen::Index>(joints.size()), count);
    EXPECT_NEAR(choices.shares.row(v).sum(), 1.0f, 1e-3f);
  }
}

TEST(BoneChoices, touching_capsules_keep_their_own_shares) {
  const test::Bound two = test::touching_capsules(2);
  const geometry::CleanMesh clean = geometry::clean(two.mesh);
  const BoneChoices choices = bone_choices(clean.mesh, two.skeleton);
  for (VertexId v : two.mesh.positions.ids()) {
    const bool first = index(v) < two.mesh.positions.size() / 2;
    const auto row = static_cast<Eigen::Index>(index(clean.from_original[v]));
    for (Eigen::Index k = 0; k < choices.nearest.cols(); ++k) {
      if (choices.nearest(row, k) < 0) continue;
      const std::size_t joint = index(joint_of(choices, row, k));
      if (joint == 0) continue;
      const bool of_first = joint == 1 || joint == 2;
      if (of_first != first) EXPECT_LT(choices.shares(row, k), 0.01f);
    }
  }
}

TEST(NeuroFeatures, a_joint_s_row_says_its_kind_and_all_numbers_are_finite) {
  const test::Bound hand = test::touching_capsules(5);
  const TriangleMesh mesh = geometry::clean(hand.mesh).mesh;
  const SuperSkeleton super({{{"a", Side::none}, Vec3f::Zero(), 3}, {{}, Vec3f::Zero(), 0}});
  const BoneChoices choices = bone_choices(mesh, hand.skeleton);
  const auto normals = vertex_normals(mesh);
  SlotAssignment all_first;
  all_first.slot = PerJoint<std::size_t>(hand.skeleton.size(), 0);
  all_first.by_name = PerJoint<bool>(hand.skeleton.size(), true);
  const ChoiceRows rows = choice_rows(mesh.positions.raw(), normals.raw(), hand.skeleton, choices, super, all_first, 5);
  EXPECT_EQ(rows.features.size(), rows.joints.size() * kChoiceFeatures);
  EXPECT_EQ(rows.joint_features.size(), rows.chosen.size() * (kJointFeatures + 5));
  for (std::size_t b = 0; b < rows.chosen.size(); ++b)
    for (std::size_t kind = 0; kind < 5; ++kind)
      EXPECT_EQ(rows.joint_features[b * (kJointFeatures + 5) + kJointFeatures + kind], kind == 3 ? 1.0f : 0.0f);
  for (const float x : rows.features) ASSERT_TRUE(std::isfinite(x));
  for (const float x : rows.joint_features) ASSERT_TRUE(std::isfinite(x));
}

TEST(NeuroFeatures, the_paper_s_rows_hold_straight_distances_and_a_constant_for_what_is_not_there) {
  const std::vector<Vec3f> positions{{0.3f, 0.2f, 0}, {0, 1.5f, 0}}, normals{{1, 0, 0}, {0, 1, 0}};
  Skeleton s;
  const JointId hips = s.add("hips", std::nullopt, {0, 0.1f, 0});
  s.add("head", hips, {0, 1, 0});
  const SuperSkeleton super(
      {{{"head", Side::none}, Vec3f::Zero(), 1}, {{"hips", Side::none}, Vec3f::Zero(), 2}, {{"tail", Side::none}, Vec3f::Zero(), 3}});
  const std::vector<float> rows = slot_rows(positions, normals, s, super, super.assign(s), 4);
  ASSERT_EQ(rows.size(), 2u * 10u);
  const std::vector<float> expected{0.3f, 0.1f, 0,    1,    0,       0,      std::hypot(0.3f, 0.8f), 0.3f, kNoSlot, kNoSlot, 0, 1.4f, 0, 0,
                                    1,    0,    0.5f, 0.5f, kNoSlot, kNoSlot};
  for (std::size_t i = 0; i < rows.size(); ++i) EXPECT_NEAR(rows[i], expected[i], 1e-6f) << i;
}

}  // namespace
}  // namespace osteon::skin
