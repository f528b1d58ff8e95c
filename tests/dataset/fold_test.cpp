// SPDX-License-Identifier: Apache-2.0
#include "osteon/dataset/fold.h"

#include <gtest/gtest.h>

#include "capsule_character.h"

namespace osteon::dataset {
namespace {

// The capsule with three joints, and a fourth at its upper end that moves nothing.
const PreparedCharacter& capsule() {
  static const PreparedCharacter prepared = [] {
    Rig rig = test::capsule_character();
    rig.skeleton.add("end", JointId{2}, Vec3f(0, 2.2f, 0));
    PrepareOptions options;
    options.working_mesh = {300, 200, 5000};
    return prepare(rig, {"capsule", "capsules", "other"}, options);
  }();
  return prepared;
}

float moved_by(const PreparedCharacter& character, const std::string& name) {
  float sum = 0.0f;
  for (VertexId v : character.mesh.positions.ids())
    for (const Influence& i : character.weights[v])
      if (character.skeleton.names[i.joint] == name) sum += i.weight;
  return sum;
}

TEST(Folded, loses_the_joint_that_moves_nothing_first) {
  Random random(1);
  const PreparedCharacter coarse = folded(capsule(), 3, std::nullopt, random);
  EXPECT_EQ(coarse.skeleton.names, (PerJoint<std::string>{"low", "middle", "high"}));
  EXPECT_EQ(coarse.weights, capsule().weights);
}

TEST(Folded, gives_the_weights_of_lost_joints_to_the_next_one_that_stays) {
  for (std::uint64_t seed = 1; seed <= 8; ++seed) {
    Random random(seed);
    const PreparedCharacter coarse = folded(capsule(), 2, std::nullopt, random);
    validate(coarse.skeleton);
    validate(coarse.weights, coarse.vertices(), coarse.joints());
    ASSERT_EQ(coarse.joints(), 2u);
    const float all = moved_by(coarse, "low") + moved_by(coarse, coarse.skeleton.names[JointId{1}]);
    EXPECT_NEAR(all, static_cast<float>(coarse.vertices()), 1e-2f);
    // Which of the two upper joints is lost is chance; the one that stays carries both parts, unless the lower part took the middle's.
    const bool middle_stays = coarse.skeleton.names[JointId{1}] == "middle";
    const float upper = moved_by(capsule(), "high") + (middle_stays ? moved_by(capsule(), "middle") : 0.0f);
    EXPECT_NEAR(moved_by(coarse, coarse.skeleton.names[JointId{1}]), upper, 1e-2f);
  }
}

TEST(Folded, keeps_the_root_and_the_places_of_the_joints_that_stay) {
  Random random(2);
  const PreparedCharacter one = folded(capsule(), 1, std::nullopt, random);
  EXPECT_EQ(one.skeleton.names, PerJoint<std::string>{"low"});
  EXPECT_EQ(one.skeleton.rest_positions[JointId{0}], capsule().skeleton.rest_positions[JointId{0}]);
  for (VertexId v : one.mesh.positions.ids()) EXPECT_EQ(one.weights[v].size(), 1u);
}

// A trunk with two arms that mirror one another: with a plane of symmetry both arms go at once, so the number may be one below.
TEST(Folded, takes_mirror_partners_together) {
  PreparedCharacter figure = capsule();
  figure.skeleton = {};
  figure.skeleton.add("hips", std::nullopt, Vec3f(0, 0.5f, 0));
  figure.skeleton.add("left", JointId{0}, Vec3f(0.2f, 0.8f, 0));
  figure.skeleton.add("right", JointId{0}, Vec3f(-0.2f, 0.8f, 0));
  figure.skeleton.add("head", JointId{0}, Vec3f(0, 1.0f, 0));
  figure.weights = {};
  for ([[maybe_unused]] VertexId v : figure.mesh.positions.ids())
    figure.weights.append(std::vector<Influence>{{JointId{0}, 0.5f}, {JointId{1}, 0.01f}, {JointId{2}, 0.02f}, {JointId{3}, 0.47f}});
  Random random(5);
  const PreparedCharacter coarse = folded(figure, 3, Plane{Vec3f::UnitX(), 0.0f}, random);
  EXPECT_EQ(coarse.skeleton.names, (PerJoint<std::string>{"hips", "head"}));
}

}  // namespace
}  // namespace osteon::dataset
