// SPDX-License-Identifier: Apache-2.0
#include "osteon/dataset/batch.h"

#include <cmath>
#include <map>

#include "capsule_character.h"
#include "osteon/mesh/shapes.h"
#include "support/expect.h"

namespace osteon::dataset {
namespace {

// A capsule with a ball on its last joint, in two poses of its own.
PreparedCharacter capsule_with_hat() {
  Rig rig = test::capsule_character();
  TriangleMesh hat = shapes::icosphere(1, 0.08f);
  for (Vec3f& p : hat.positions) p += Vec3f(0, 2.4f, 0);
  rig.mesh = shapes::merged(rig.mesh, hat);
  const Influence whole{JointId{2}, 1.0f};
  for (std::size_t v = 0; v < hat.positions.size(); ++v) rig.weights.append({&whole, 1});
  PrepareOptions options;
  options.working_mesh = {700, 600, 5000};
  PreparedCharacter character = prepare(rig, {"capsule", "capsules", "other"}, options);
  Random random(1);
  for (int i = 0; i < 2; ++i)
    character.poses.push_back(random_articulation(character.skeleton, std::nullopt, {.proportion = 0.0f}, random));
  return character;
}

const std::vector<Example>& examples(Parts parts) {
  static std::map<Parts, std::vector<Example>> made;
  if (!made.contains(parts)) made[parts] = examples_of({capsule_with_hat()}, parts);
  return made[parts];
}

Batch batch_of(Parts parts, const AugmentOptions& options, std::uint64_t seed) {
  Random random(seed);
  const std::shared_ptr<const Example> changed = varied(examples(parts)[0], parts, options, random);
  const Example* one[] = {changed.get()};
  return training_batch(one, {.parts = parts}, options, random);
}

TEST(TrainingBatch, of_all_changes_together_fits_together) {
  AugmentOptions all;
  all.articulate.from_motion = 0.7f;
  all.drop = all.flip = all.fold = 0.7f;
  for (const Parts parts : {Parts::joints, Parts::pairs, Parts::skin, Parts::bind, Parts::tree})
    for (std::uint64_t seed = 1; seed < 9; ++seed) {
      const Batch batch = batch_of(parts, all, seed);
      const std::size_t joints = batch.inputs.joints.positions.size() / 3, vertices = batch.inputs.mesh.positions.size() / 3;
      EXPECT_GE(joints, 2u);
      if (parts == Parts::tree) EXPECT_EQ(batch.targets.parents.size(), joints);
      if (parts == Parts::joints) EXPECT_EQ(batch.targets.attention.size(), vertices);
      if (parts == Parts::pairs) EXPECT_EQ(batch.targets.connected.size(), joints * (joints - 1) / 2);
      if (parts == Parts::skin || parts == Parts::bind) EXPECT_EQ(batch.targets.skin_share.size(), vertices);
      for (const float x : batch.inputs.mesh.positions) EXPECT_TRUE(std::isfinite(x));
    }
}

TEST(PlainBatch, hides_the_shape_or_the_joints_and_nothing_else) {
  const Example* one[] = {&examples(Parts::pairs)[0]};
  const Batch whole = plain_batch(one, {.parts = Parts::pairs});
  const Batch hidden = plain_batch(one, {.parts = Parts::pairs, .hide_mesh = true, .hide_joints = true});
  Example grown = *one[0];
  for (Vec3f& p : grown.character.mesh.positions) p *= 1.1f;
  for (Vec3f& p : grown.character.skeleton.rest_positions) p *= 1.1f;
  const Example* other[] = {&grown};
  const Batch as_hidden = plain_batch(other, {.parts = Parts::pairs, .hide_mesh = true, .hide_joints = true});
  EXPECT_EQ(hidden.inputs.mesh.positions, as_hidden.inputs.mesh.positions);
  EXPECT_EQ(hidden.inputs.joints.positions, as_hidden.inputs.joints.positions);
  EXPECT_NE(whole.inputs.mesh.positions, plain_batch(other, {.parts = Parts::pairs}).inputs.mesh.positions);
  EXPECT_NE(hidden.inputs.mesh.positions, whole.inputs.mesh.positions);
  EXPECT_NE(hidden.inputs.joints.positions, whole.inputs.joints.positions);
  EXPECT_EQ(hidden.inputs.pairs.features, whole.inputs.pairs.features);
  EXPECT_EQ(hidden.targets.connected, whole.targets.connected);
}

TEST(TrainingBatch, changes_that_are_off_draw_no_random_numbers) {
  PreparedCharacter without_poses = examples(Parts::joints)[0].character;
  without_poses.poses.clear();
  const auto unposed = examples_of({without_poses}, Parts::joints);
  Random random(3);
  const std::shared_ptr<const Example> changed = varied(unposed[0], Parts::joints, {}, random);
  const Example* one[] = {changed.get()};
  EXPECT_EQ(training_batch(one, {}, {}, random).inputs.mesh.positions, batch_of(Parts::joints, {}, 3).inputs.mesh.positions);
}

TEST(Draw, gives_no_more_than_there_is_weight_for) {
  Random random(1);
  const std::vector<double> two{0.0, 0.3, 0.0, 0.7}, none{0.0, 0.0};
  EXPECT_THAT(draw(two, 3, random), testing::UnorderedElementsAre(1, 3));
  EXPECT_THAT(draw(two, 1, random), testing::SizeIs(1));
  EXPECT_THAT(draw(none, 2, random), testing::IsEmpty());
}

// Of poses alone, without random ones: the bend between the bones is that of one of the two poses.
TEST(TrainingBatch, from_motion_stands_in_the_characters_own_poses) {
  AugmentOptions options = AugmentOptions::none();
  options.articulate = {.probability = 1.0f, .proportion = 0.0f, .from_motion = 1.0f};
  const auto bend = [](const Vec3f& a, const Vec3f& b, const Vec3f& c) { return (b - a).normalized().dot((c - b).normalized()); };
  std::vector<float> of_poses;
  for (const Articulation& pose : examples(Parts::joints)[0].character.poses)
    of_poses.push_back(bend(pose.joints[JointId{0}], pose.joints[JointId{1}], pose.joints[JointId{2}]));
  for (std::uint64_t seed = 1; seed < 6; ++seed) {
    const std::vector<float> p = batch_of(Parts::joints, options, seed).inputs.joints.positions;
    const float found = bend({p[0], p[1], p[2]}, {p[3], p[4], p[5]}, {p[6], p[7], p[8]});
    EXPECT_THAT(of_poses, testing::Contains(testing::FloatNear(found, 1e-4f)));
  }
}

}  // namespace
}  // namespace osteon::dataset
