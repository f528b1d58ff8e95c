// SPDX-License-Identifier: Apache-2.0
#include "osteon/synth/body.h"

#include "osteon/base/random.h"
#include "support/expect.h"

namespace osteon::synth {
namespace {

Vec3f random_point(Random& random) {
  const float x = random.uniform(-1, 1), y = random.uniform(-1, 1), z = random.uniform(-1, 1);
  return {x, y, z};
}

// Distance to the hull of two balls, by the largest ball that sweeps between them.
float swept_distance(const RoundCone& cone, const Vec3f& p) {
  float nearest = std::numeric_limits<float>::max();
  for (int i = 0; i <= 4000; ++i) {
    const float t = static_cast<float>(i) / 4000.0f;
    const Vec3f centre = cone.axis.a + t * (cone.axis.b - cone.axis.a);
    nearest = std::min(nearest, (p - centre).norm() - (cone.radius_a + t * (cone.radius_b - cone.radius_a)));
  }
  return nearest;
}

TEST(RoundCone, is_the_hull_of_the_balls_between_its_ends) {
  Random random(1);
  for (int i = 0; i < 50; ++i) {
    const RoundCone cone{{random_point(random), random_point(random)}, random.uniform(0.1f, 0.4f), random.uniform(0.1f, 0.4f)};
    for (int k = 0; k < 20; ++k) {
      const Vec3f p = random_point(random);
      EXPECT_NEAR(signed_distance(cone, p), swept_distance(cone, p), 1e-3f);
    }
  }
}

TEST(RoundCone, flattened_is_thinner_one_way_and_claims_no_more_than_the_true_distance) {
  const RoundCone ball{{Vec3f::Zero(), Vec3f::Zero()}, 0.5f, 0.5f, Vec3f::UnitZ(), 0.4f};
  EXPECT_NEAR(signed_distance(ball, Vec3f(0.5f, 0, 0)), 0.0f, 1e-6f);
  EXPECT_NEAR(signed_distance(ball, Vec3f(0, 0, 0.2f)), 0.0f, 1e-6f);
  EXPECT_LE(signed_distance(ball, Vec3f(0, 0, 1.0f)), 0.8f + 1e-6f);
  EXPECT_LE(signed_distance(ball, Vec3f(1.0f, 0, 0)), 0.5f + 1e-6f);
}

// A trunk along y with an arm to each side.
class ArmedBody : public testing::Test {
 protected:
  ArmedBody() {
    trunk = body.joint("Trunk", std::nullopt, Vec3f::Zero());
    arm = body.pair("Arm", trunk, Vec3f(0.2f, 0.5f, 0));
    hand = body.pair("Hand", arm, Vec3f(0.7f, 0.5f, 0));
    body.clothe(trunk, {{Vec3f::Zero(), Vec3f(0, 0.6f, 0)}, 0.15f, 0.15f}, 0.05f);
    body.clothe(arm, {{Vec3f(0.2f, 0.5f, 0), Vec3f(0.7f, 0.5f, 0)}, 0.08f, 0.06f}, 0.05f);
    body.clothe(hand, {{Vec3f(0.7f, 0.5f, 0), Vec3f(0.9f, 0.5f, 0)}, 0.06f, 0.05f}, 0.02f);
  }
  float weight(const Vec3f& p, JointId joint) const {
    float share = 0.0f, sum = 0.0f;
    for (const Influence& i : body.weights(p)) {
      sum += i.weight;
      if (i.joint == joint) share = i.weight;
    }
    return share / sum;
  }
  Body body;
  JointId trunk{}, arm{}, hand{};
};

TEST_F(ArmedBody, has_a_twin_for_each_joint_of_a_side) {
  EXPECT_EQ(body.skeleton().names, (PerJoint<std::string>{"Trunk", "LeftArm", "RightArm", "LeftHand", "RightHand"}));
  const JointId right_hand = body.mirrored(hand);
  EXPECT_EQ(body.skeleton().parents[right_hand], body.mirrored(arm));
  EXPECT_VEC3_NEAR(body.at(right_hand), Vec3f(-0.7f, 0.5f, 0), 0.0f);
  EXPECT_EQ(body.mirrored(trunk), trunk);
}

TEST_F(ArmedBody, is_symmetric) {
  Random random(2);
  for (int i = 0; i < 200; ++i) {
    const Vec3f p = random_point(random), q(-p.x(), p.y(), p.z());
    EXPECT_EQ(body.distance(p), body.distance(q));
    for (const Influence& on_p : body.weights(p)) EXPECT_NEAR(weight(q, body.mirrored(on_p.joint)), weight(p, on_p.joint), 1e-6f);
  }
}

TEST_F(ArmedBody, is_the_same_near_a_point_without_the_far_parts) {
  Random random(3);
  for (int i = 0; i < 100; ++i) {
    const Vec3f centre = random_point(random), p = centre + 0.05f * random_point(random);
    EXPECT_EQ(body.near(centre, 0.1f)(p), body.distance(p));
  }
}

TEST_F(ArmedBody, binds_the_middle_of_a_bone_to_it_alone_and_the_joint_to_both_alike) {
  EXPECT_EQ(weight(Vec3f(0.45f, 0.57f, 0), arm), 1.0f);
  EXPECT_NEAR(weight(Vec3f(0.7f, 0.56f, 0), arm), 0.5f, 0.02f);  // the arm's cone narrows: its side leans a little
  EXPECT_NEAR(weight(Vec3f(0.7f, 0.56f, 0), hand), 0.5f, 0.02f);
}

TEST_F(ArmedBody, fills_its_box) {
  const auto box = body.box();
  EXPECT_TRUE(box.contains(Vec3f(0.95f, 0.5f, 0)));
  EXPECT_TRUE(box.contains(Vec3f(-0.95f, 0.5f, 0)));
  EXPECT_TRUE(box.contains(Vec3f(0, -0.15f, 0)));
}

}  // namespace
}  // namespace osteon::synth
