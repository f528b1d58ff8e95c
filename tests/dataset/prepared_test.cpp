// SPDX-License-Identifier: Apache-2.0
#include "osteon/dataset/prepared.h"

#include <numeric>

#include "capsule_character.h"
#include "support/expect.h"

namespace osteon::dataset {
namespace {

const CharacterInfo kInfo{"capsule", "shapes", "other"};

class PreparedCapsule : public testing::Test {
 protected:
  static void SetUpTestSuite() { character_ = prepare(test::capsule_character(), kInfo); }
  static void TearDownTestSuite() { character_.reset(); }
  static const PreparedCharacter& character() { return *character_; }

 private:
  static inline std::optional<PreparedCharacter> character_;
};

TEST_F(PreparedCapsule, stands_in_the_frame_of_the_networks) {
  const auto box = bounds(character().mesh);
  EXPECT_NEAR(box.sizes().maxCoeff(), 1.0f, 0.01f);
  EXPECT_NEAR(box.min().y(), 0.0f, 0.01f);
  EXPECT_NEAR(box.center().x(), 0.0f, 0.01f);
  EXPECT_GE(character().vertices(), 1000u);
  EXPECT_LE(character().vertices(), 2500u);
  const auto& joints = character().skeleton.rest_positions;
  EXPECT_VEC3_NEAR(joints[JointId{0}], Vec3f(0, 0.2f / 2.4f, 0), 1e-3f);
  EXPECT_VEC3_NEAR(joints[JointId{2}], Vec3f(0, 2.2f / 2.4f, 0), 1e-3f);
}

TEST_F(PreparedCapsule, fits_together) {
  const PreparedCharacter& c = character();
  validate(c.mesh);
  validate(c.skeleton);
  validate(c.weights, c.vertices(), c.joints());
  EXPECT_EQ(c.one_ring.size(), c.vertices());
  EXPECT_EQ(c.balls.members.size(), c.vertices());
  EXPECT_EQ(c.attention.size(), c.vertices());
  EXPECT_EQ(c.tolerances.size(), c.joints());
  EXPECT_EQ(c.nearest_bones.rows(), static_cast<Eigen::Index>(c.vertices()));
  EXPECT_EQ(c.nearest_bones.cols(), 3);  // two bones and the point at the leaf
}

TEST_F(PreparedCapsule, keeps_the_weights_of_the_places) {
  const PreparedCharacter& c = character();
  for (VertexId v : c.mesh.positions.ids()) {
    const float y = c.normalization.undo(c.mesh.positions[v]).y();
    for (const Influence& i : c.weights[v]) {
      if (i.joint != JointId{1}) continue;
      const float expected = std::clamp(2.0f * y - 1.5f, 0.0f, 1.0f) - std::clamp(2.0f * y - 3.5f, 0.0f, 1.0f);
      EXPECT_NEAR(i.weight, expected, 0.45f);  // the original's rings are 0.17 apart at the kinks of this function of slope 2
    }
  }
}

TEST_F(PreparedCapsule, knows_the_radius_as_tolerance) { EXPECT_NEAR(character().tolerances[JointId{1}], 0.2f / 2.4f, 0.005f); }

TEST_F(PreparedCapsule, marks_rings_around_the_joints) {
  const PreparedCharacter& c = character();
  for (VertexId v : c.mesh.positions.ids()) {
    float nearest = 1.0f;
    for (const Vec3f& joint : c.skeleton.rest_positions) nearest = std::min(nearest, std::abs(c.mesh.positions[v].y() - joint.y()));
    if (c.attention[index(v)]) EXPECT_LT(nearest, 0.1f);
  }
  EXPECT_GT(std::accumulate(c.attention.begin(), c.attention.end(), 0), 12);
}

TEST_F(PreparedCapsule, gives_the_skin_network_nearest_bones_and_their_weights) {
  const PreparedCharacter& c = character();
  const auto inputs = skin_inputs(c, 3);
  const auto targets = skin_targets(c, inputs.nearest);
  EXPECT_EQ(inputs.features.cols(), 3 + 3 * geometry::kBoneFeatures);
  for (float covered : targets.covered) EXPECT_NEAR(covered, 1.0f, 1e-5f);  // all bones are among three
  for (Eigen::Index v = 0; v < inputs.nearest.rows(); ++v) EXPECT_EQ(inputs.nearest.row(v), c.nearest_bones.row(v));
}

TEST(Prepare, notes_merged_joints_and_joints_outside) {
  Rig rig = test::capsule_character();
  rig.skeleton.add("stacked", JointId{2}, rig.skeleton.rest_positions[JointId{2}]);
  rig.skeleton.add("far away", JointId{2}, Vec3f(0, 5, 0));
  const PreparedCharacter c = prepare(rig, kInfo);
  EXPECT_EQ(c.joints(), 4u);
  EXPECT_THAT(c.notes, testing::ElementsAre("1 joints merged with one at the same place", "1 of 4 joints outside the shape"));
}

TEST(Prepare, refuses_a_broken_rig) {
  Rig rig = test::capsule_character();
  rig.weights = {};
  EXPECT_THAT(test::error_of([&] { prepare(rig, kInfo); }), testing::HasSubstr("skin weights for 0 vertices"));
}

TEST(PairLabels, are_1_for_parent_and_child_in_the_order_of_the_features) {
  Skeleton s;  // 1 and 2 below 0, 3 below 1
  s.add("0", std::nullopt, Vec3f::Zero());
  s.add("1", JointId{0}, Vec3f::UnitX());
  s.add("2", JointId{0}, Vec3f::UnitY());
  s.add("3", JointId{1}, Vec3f::UnitZ());
  //                                                              01 02 03 12 13 23
  EXPECT_EQ(pair_labels(s), (std::vector<std::uint8_t>{1, 1, 0, 0, 1, 0}));
  EXPECT_EQ(parent_indices(s), (std::vector<int>{-1, 0, 0, 1}));
}

}  // namespace
}  // namespace osteon::dataset
