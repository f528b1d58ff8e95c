// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/hand_shape.h"

#include <algorithm>
#include <string>

#include "figure_with_hands.h"
#include "osteon/mesh/shapes.h"
#include "osteon/pipelines/joint_set.h"
#include "support/expect.h"

namespace osteon::pipelines {
namespace {

using test::FigureWithHands;

std::optional<HandShape> left_hand(const FigureWithHands& figure) {
  return find_hand(figure.mesh, figure.at("LeftHand"), figure.at("LeftArm"));
}

// From a point to the line through a finger's tip and joints.
float distance(const Vec3f& p, const FingerShape& finger) {
  float nearest = (finger.tip - p).norm();
  Vec3f outer = finger.tip;
  for (auto joint = finger.joints.rbegin(); joint != finger.joints.rend(); outer = *joint++)
    for (int s = 0; s <= 50; ++s) nearest = std::min(nearest, (outer + static_cast<float>(s) / 50.0f * (*joint - outer) - p).norm());
  return nearest;
}

TEST(FindHand, fingers_run_through_the_joints_of_generated_hands_thumb_first) {
  const std::array<std::string, 4> names{"Thumb", "Index", "Middle", "Ring"};
  for (std::uint64_t seed : {1, 4}) {
    const FigureWithHands figure = test::figure_with_hands(3, seed);
    const auto hand = left_hand(figure);
    ASSERT_TRUE(hand);
    ASSERT_EQ(hand->fingers.size(), names.size());
    for (std::size_t k = 0; k < names.size(); ++k) {
      const FingerShape& finger = hand->fingers[k];
      EXPECT_LT(distance(figure.at("LeftHand" + names[k] + "2"), finger), 0.2f * finger.wide) << names[k];
      ASSERT_EQ(finger.joints.size(), 3u);
      EXPECT_GT((finger.tip - finger.joints[0]).norm(), (finger.tip - finger.joints[1]).norm());
      EXPECT_GT((finger.tip - finger.joints[1]).norm(), (finger.tip - finger.joints[2]).norm());
    }
    for (std::size_t k = 1; k < names.size(); ++k) {  // these are straight: places along them are lengths, but for the round tips
      const FingerShape& finger = hand->fingers[k];
      EXPECT_NEAR((finger.tip - finger.joints[1]).norm() / (finger.tip - finger.joints[2]).norm(), 1.9f, 0.3f);
    }
    ASSERT_TRUE(hand->wrist);
    EXPECT_LT((*hand->wrist - figure.at("LeftHand")).norm(), 0.025f);
  }
}

// Both hands within reach of either arm's end, as those of short arms are.
TEST(FindHand, of_two_hands_it_is_the_nearer_one) {
  const FigureWithHands figure = test::figure_with_hands(3, 1);
  const Vec3f apart(0, 0, 0.1f);
  const TriangleMesh two = shapes::merged(figure.mesh, shapes::shifted(figure.mesh, apart));
  const Vec3f end = figure.at("LeftHand"), from = figure.at("LeftArm") + apart;
  const auto here = find_hand(two, end, from), there = find_hand(two, end + apart, from);
  ASSERT_TRUE(here && there);
  EXPECT_NEAR((there->fingers.back().tip - here->fingers.back().tip - apart).norm(), 0.0f, 0.01f);
}

TEST(FindHand, a_mirror_image_has_the_mirror_image) {
  const FigureWithHands figure = test::figure_with_hands(3, 1);
  const auto left = left_hand(figure), right = find_hand(figure.mesh, figure.at("RightHand"), figure.at("RightArm"));
  ASSERT_TRUE(left && right);
  EXPECT_LT((*left->wrist - mirrored(*right->wrist)).norm(), 2e-3f);
  for (std::size_t k = 0; k < left->fingers.size(); ++k)
    for (std::size_t i = 0; i < 3; ++i) EXPECT_LT((left->fingers[k].joints[i] - mirrored(right->fingers[k].joints[i])).norm(), 2e-3f);
}

TEST(FindHand, mittens_and_feet_are_no_hands) {
  const FigureWithHands mitten = test::figure_with_hands(0, 1, 160), figure = test::figure_with_hands(3, 1);
  EXPECT_FALSE(left_hand(mitten));
  EXPECT_FALSE(find_hand(figure.mesh, figure.at("LeftFoot"), figure.at("LeftUpLeg")));
}

TEST(FindHand, nothing_near_is_no_hand) {
  EXPECT_FALSE(find_hand(shapes::icosphere(2), {5, 5, 5}, {0, 0, 0}));
  EXPECT_FALSE(find_hand(shapes::icosphere(2, 0.1f), {0, 0, 0}, {0, 0, 0}));
}

}  // namespace
}  // namespace osteon::pipelines
