// SPDX-License-Identifier: Apache-2.0
#include "osteon/dataset/articulate.h"

#include <gtest/gtest.h>

#include "capsule_character.h"

namespace osteon::dataset {
namespace {

// A trunk in the plane x = 0, two arms that mirror one another.
Skeleton figure() {
  Skeleton s;
  s.add("hips", std::nullopt, Vec3f(0, 0.5f, 0));
  s.add("chest", JointId{0}, Vec3f(0, 0.8f, 0.02f));
  s.add("left", JointId{1}, Vec3f(0.2f, 0.8f, 0));
  s.add("right", JointId{1}, Vec3f(-0.2f, 0.8f, 0));
  s.add("left_hand", JointId{2}, Vec3f(0.5f, 0.7f, 0.1f));
  s.add("right_hand", JointId{3}, Vec3f(-0.5f, 0.7f, 0.1f));
  return s;
}

const Plane kMiddle{Vec3f(1, 0, 0), 0.0f};

TEST(MirrorPartners, are_found_by_place_and_only_with_a_plane) {
  using Partners = PerJoint<std::optional<JointId>>;
  EXPECT_EQ(mirror_partners(figure(), kMiddle), (Partners{JointId{0}, JointId{1}, JointId{3}, JointId{2}, JointId{5}, JointId{4}}));
  EXPECT_EQ(mirror_partners(figure(), std::nullopt), Partners(6));
  Skeleton one_sided = figure();
  one_sided.rest_positions[JointId{5}].y() += 0.1f;
  EXPECT_EQ(mirror_partners(one_sided, kMiddle)[JointId{4}], std::nullopt);
}

TEST(RandomArticulation, changes_both_sides_alike_when_asked_to) {
  Random random(3);
  const ArticulateOptions options{.symmetric = 1.0f, .largest_bend = 0.6f};
  for (int i = 0; i < 20; ++i) {
    const Articulation a = random_articulation(figure(), kMiddle, options, random);
    for (const auto& [left, right] : {std::pair{2, 3}, {4, 5}})
      EXPECT_LT((a.joints[JointId(left)] - kMiddle.mirror(a.joints[JointId(right)])).norm(), 1e-5f);
    for (const int middle : {0, 1}) EXPECT_NEAR(a.joints[JointId(middle)].x(), 0.0f, 1e-6f);
    EXPECT_GT((a.joints[JointId{4}] - figure().rest_positions[JointId{4}]).norm(), 1e-4f);
  }
}

TEST(Articulated, joints_axes_turn_with_their_parts) {
  Articulation a{PerJoint<Eigen::Matrix3f>(3, Eigen::Matrix3f::Identity()), test::prepared_capsule().skeleton.rest_positions};
  const Quatf turn(Eigen::AngleAxisf(0.4f, Vec3f::UnitZ()));
  a.linear[JointId{1}] = 1.3f * turn.toRotationMatrix();
  const PreparedCharacter changed = articulated(test::prepared_capsule(), a);
  for (const std::uint16_t j : {0, 1, 2}) {
    const Quatf& before = test::prepared_capsule().skeleton.rest_orientations[JointId{j}];
    EXPECT_LT(changed.skeleton.rest_orientations[JointId{j}].angularDistance(j == 1 ? turn * before : before), 1e-3f);
  }
}

TEST(RandomArticulation, without_bends_and_proportions_is_the_rest_pose) {
  Random random(3);
  const Articulation a = random_articulation(figure(), kMiddle, {.largest_bend = 0.0f, .proportion = 0.0f}, random);
  EXPECT_EQ(a.joints, figure().rest_positions);
  for (const Eigen::Matrix3f& m : a.linear) EXPECT_TRUE(m.isIdentity(1e-6f));
}

TEST(RandomArticulation, without_proportions_keeps_the_lengths_of_bones) {
  Random random(5);
  const Skeleton rest = figure();
  const Articulation a = random_articulation(rest, std::nullopt, {.largest_bend = 1.0f, .proportion = 0.0f}, random);
  for (const Bone& bone : bones(rest))
    if (bone.end) EXPECT_NEAR((a.joints[*bone.end] - a.joints[bone.start]).norm(), (bone.segment.b - bone.segment.a).norm(), 1e-5f);
}

TEST(WithSizes, stretches_the_bones_of_a_pose_and_leaves_its_turns) {
  Random random(5);
  const Skeleton rest = figure();
  const Articulation pose = random_articulation(rest, std::nullopt, {.largest_bend = 1.0f, .proportion = 0.0f}, random);
  const Articulation sizes = random_articulation(rest, std::nullopt, {.largest_bend = 0.0f, .proportion = 0.3f}, random);
  const Articulation both = with_sizes(pose, sizes, rest);
  for (const Bone& bone : bones(rest)) {
    const JointId j = bone.start;
    const float size = std::cbrt(sizes.linear[j].determinant());
    EXPECT_TRUE(both.linear[j].isApprox(size * pose.linear[j], 1e-4f));
    if (bone.end) EXPECT_LT((both.joints[*bone.end] - both.joints[j] - size * (pose.joints[*bone.end] - pose.joints[j])).norm(), 1e-5f);
  }
}

// Doing nothing gives what prepare() gave, but for the scale: that was of the original's box, and the reduced mesh fills it less.
TEST(Articulated, derives_the_same_as_preparing) {
  const Skeleton& rest = test::prepared_capsule().skeleton;
  const Articulation nothing{PerJoint<Eigen::Matrix3f>(rest.size(), Eigen::Matrix3f::Identity()), rest.rest_positions};
  PreparedCharacter same = articulated(test::prepared_capsule(), nothing);
  derive_from_shape(same, Parts::skin);
  for (VertexId v : same.mesh.positions.ids())
    EXPECT_LT((same.mesh.positions[v] - test::prepared_capsule().mesh.positions[v]).norm(), 2e-3f);
  EXPECT_LT((same.nearest_distances - test::prepared_capsule().nearest_distances).cwiseAbs().maxCoeff(), 5e-3f);
  derive_from_shape(same, Parts::joints);
  int other = 0;
  for (std::size_t v = 0; v < same.vertices(); ++v) other += same.attention[v] != test::prepared_capsule().attention[v] ? 1 : 0;
  EXPECT_LE(other, static_cast<int>(same.vertices() / 20));  // at the rim of a marked region
}

TEST(Articulated, stays_in_the_frame_of_the_networks_with_joints_inside) {
  Random random(7);
  for (int i = 0; i < 5; ++i) {
    const Articulation bent = random_articulation(test::prepared_capsule().skeleton, std::nullopt, {.largest_bend = 0.6f}, random);
    PreparedCharacter out = articulated(test::prepared_capsule(), bent);
    derive_from_shape(out, Parts::pairs);
    Eigen::AlignedBox3f box;
    for (const Vec3f& p : out.mesh.positions) box.extend(p);
    EXPECT_NEAR(box.sizes().maxCoeff(), 1.0f, 1e-5f);
    EXPECT_NEAR(box.min().y(), 0.0f, 1e-5f);
    for (const Vec3f& p : out.skeleton.rest_positions) EXPECT_TRUE(out.voxels.inside(p));
  }
}

}  // namespace
}  // namespace osteon::dataset
