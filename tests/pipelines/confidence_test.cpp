// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/confidence.h"

#include <gtest/gtest.h>

#include "osteon/mesh/shapes.h"

namespace osteon::pipelines {
namespace {

// Two joints in a box, one seen by many votes and one by few.
struct Scene {
  TriangleMesh mesh = shapes::box({1, 1, 1});
  JointSet joints{{}, {{0.2f, 0, 0}, {-0.2f, 0.1f, 0}}, {std::nullopt, std::nullopt}};
  JointCandidates votes;

  Scene() {
    for (int i = 0; i < 9; ++i) vote({0.2f, 0, 0}, 0.9f);
    vote({-0.2f, 0.1f, 0.03f}, 0.5f);
  }
  void vote(const Vec3f& at, float attention) {
    votes.positions.push_back(at);
    votes.attention.push_back(attention);
  }
  std::vector<JointEvidence> evidence() const { return joint_evidence(votes, joints, mesh); }
};

TEST(JointEvidence, is_what_its_names_say) {
  const auto e = Scene().evidence();
  const float all = 9 * 0.9f + 0.5f;
  EXPECT_NEAR(std::exp(e[0][0]), 9 * 0.9f / all, 1e-4f);
  EXPECT_NEAR(std::exp(e[1][0]), 0.75f * 0.5f / all, 1e-4f);  // half way to the reach: 1 - 0.5^2
  EXPECT_NEAR(e[0][1], 0.9f, 1e-5f);
  EXPECT_NEAR(std::exp(e[0][2]), 0.3f, 1e-5f);
}

TEST(JointEvidence, is_the_same_for_both_sides_of_a_pair) {
  Scene scene;
  scene.joints.partner = {1, 0};
  const auto e = scene.evidence();
  EXPECT_EQ(e[0], e[1]);
}

TEST(JointEvidence, stays_finite_without_any_vote) {
  Scene scene;
  scene.votes = {};
  for (const JointEvidence& e : scene.evidence())
    for (const float value : e) EXPECT_TRUE(std::isfinite(value));
}

TEST(Confidence, is_a_probability) {
  for (const JointEvidence& e : Scene().evidence()) {
    EXPECT_GT(joint_confidence(e), 0.0f);
    EXPECT_LT(joint_confidence(e), 1.0f);
  }
}

TEST(Confidence, rises_with_the_evidence_for_a_joint) {
  const auto e = Scene().evidence();
  JointEvidence less = e[0];
  for (float& x : less) {
    const float before = joint_confidence(less);
    x -= 1.0f;
    EXPECT_LE(joint_confidence(less), before);
  }
  EXPECT_LT(joint_confidence(less), joint_confidence(e[0]));
}

}  // namespace
}  // namespace osteon::pipelines
