// SPDX-License-Identifier: Apache-2.0
#include "osteon/dataset/without_accessories.h"

#include <algorithm>

#include "capsule_character.h"
#include "osteon/mesh/shapes.h"
#include "support/expect.h"

namespace osteon::dataset {
namespace {

// Adds a small ball as a part of its own that follows `joint` alone.
void add_ball(Rig& rig, const Vec3f& at, JointId joint) {
  TriangleMesh ball = shapes::icosphere(1, 0.08f);
  for (Vec3f& p : ball.positions) p += at;
  rig.mesh = shapes::merged(rig.mesh, ball);
  const Influence whole{joint, 1.0f};
  for (std::size_t i = 0; i < ball.positions.size(); ++i) rig.weights.append({&whole, 1});
}

PreparedCharacter prepared(const Rig& rig) {
  PrepareOptions options;
  options.working_mesh = {400, 300, 5000};
  return prepare(rig, {"capsule", "capsules", "other"}, options);
}

// A capsule with a hat that follows its last joint, and a sword with a joint of its own.
const PreparedCharacter& dressed() {
  static const PreparedCharacter character = [] {
    Rig rig = test::capsule_character();
    rig.skeleton.add("sword", JointId{1}, Vec3f(0.5f, 1, 0));
    add_ball(rig, Vec3f(0, 2.5f, 0), JointId{2});
    add_ball(rig, Vec3f(0.5f, 1, 0), JointId{3});
    return prepared(rig);
  }();
  return character;
}

PreparedCharacter bare() {
  Random random(1);
  return without_accessories(dressed(), 1.0f, random);
}

TEST(WithoutAccessories, the_body_is_left_with_its_joints_and_a_joint_that_moved_an_accessory_alone_goes_with_it) {
  const PreparedCharacter out = bare();
  EXPECT_EQ(connected_components(dressed().mesh).count, 3u);
  EXPECT_EQ(connected_components(out.mesh).count, 1u);
  EXPECT_EQ(out.skeleton.names, (PerJoint<std::string>{"low", "middle", "high"}));
  validate(out.mesh);
  validate(out.skeleton);
}

TEST(WithoutAccessories, the_weights_of_what_is_left_stay_and_sum_to_one) {
  const PreparedCharacter out = bare();
  validate(out.weights, out.vertices(), out.joints());
  EXPECT_EQ(out.attention.size(), out.vertices());
  const auto components = connected_components(dressed().mesh);
  std::vector<std::size_t> sizes(components.count);
  for (const std::uint32_t c : components.of) ++sizes[c];
  const auto body = std::ranges::max_element(sizes) - sizes.begin();
  VertexId kept{0};
  for (VertexId v : dressed().mesh.positions.ids()) {
    if (components.of[v] != body) continue;
    const auto before = dressed().weights[v], after = out.weights[kept];
    ASSERT_EQ(before.size(), after.size());
    float sum = 0.0f;
    for (std::size_t i = 0; i < before.size(); ++i) {
      EXPECT_EQ(before[i].joint, after[i].joint);
      EXPECT_NEAR(before[i].weight, after[i].weight, 1e-6f);
      sum += after[i].weight;
    }
    EXPECT_NEAR(sum, 1.0f, 1e-6f);
    kept = VertexId(static_cast<std::uint32_t>(index(kept) + 1));
  }
}

TEST(WithoutAccessories, is_in_the_frame_of_the_networks) {
  const Eigen::AlignedBox3f box = bounds(bare().mesh);
  EXPECT_NEAR(box.sizes().maxCoeff(), 1.0f, 1e-5f);
  EXPECT_NEAR(box.min().y(), 0.0f, 1e-5f);
}

TEST(WithoutAccessories, a_part_of_the_body_stays_where_joints_hang_below_it) {
  Rig robot;  // every joint moves a ball that nothing else holds: only the last may go
  robot.mesh = shapes::icosphere(2, 0.3f);
  robot.skeleton.add("trunk", std::nullopt, Vec3f(0, 0, 0));
  robot.skeleton.add("arm", JointId{0}, Vec3f(0.5f, 0, 0));
  robot.skeleton.add("hand", JointId{1}, Vec3f(0.9f, 0, 0));
  const Influence whole{JointId{0}, 1.0f};
  for (std::size_t v = 0; v < robot.mesh.positions.size(); ++v) robot.weights.append({&whole, 1});
  add_ball(robot, Vec3f(0.5f, 0, 0), JointId{1});
  add_ball(robot, Vec3f(0.9f, 0, 0), JointId{2});
  const PreparedCharacter character = prepared(robot);
  for (std::uint64_t seed = 1; seed < 9; ++seed) {
    Random random(seed);
    const PreparedCharacter out = without_accessories(character, 1.0f, random);
    validate(out.weights, out.vertices(), out.joints());
    PerJoint<float> moved(out.joints(), 0.0f);
    for (VertexId v : out.mesh.positions.ids())
      for (const Influence& i : out.weights[v]) moved[i.joint] += i.weight;
    for (const float m : moved) EXPECT_GT(m, 0.0f) << "a joint without a part";
    EXPECT_GE(3 * out.vertices(), 2 * character.vertices());
  }
}

TEST(WithoutAccessories, is_the_same_character_where_nothing_goes) {
  Random random(1);
  EXPECT_EQ(without_accessories(dressed(), 0.0f, random).mesh.positions, dressed().mesh.positions);
  const PreparedCharacter capsule = prepared(test::capsule_character());
  EXPECT_EQ(without_accessories(capsule, 1.0f, random).mesh.positions, capsule.mesh.positions);
}

}  // namespace
}  // namespace osteon::dataset
