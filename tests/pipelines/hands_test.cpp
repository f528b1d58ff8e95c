// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/hands.h"

#include <algorithm>
#include <map>
#include <string>

#include "figure_with_hands.h"
#include "support/expect.h"

namespace osteon::pipelines {
namespace {

using test::FigureWithHands;

const FigureWithHands& fingered() {
  static const FigureWithHands figure = test::figure_with_hands(3, 1);
  return figure;
}

// A skeleton as the networks find it: without fingers, and a joint in the middle of each palm.
struct Coarse {
  JointSet joints;
  JointTree tree;
  std::map<std::string, std::size_t> named;

  explicit Coarse(const FigureWithHands& figure, bool symmetric = true) {
    std::vector<Vec3f> positions;
    std::vector<std::optional<std::size_t>> parents;
    std::map<JointId, std::size_t> number;
    for (JointId j : figure.skeleton.names.ids()) {
      const std::string& name = figure.skeleton.names[j];
      if (name.find("Hand") != std::string::npos) continue;
      number[j] = named[name] = positions.size();
      positions.push_back(figure.skeleton.rest_positions[j]);
      const auto parent = figure.skeleton.parents[j];
      parents.push_back(parent ? std::optional(number.at(*parent)) : std::nullopt);
    }
    for (const char* side : {"Left", "Right"}) {
      const std::string prefix(side);
      named[prefix + "Palm"] = positions.size();
      positions.push_back(0.5f * (figure.at(prefix + "Hand") + figure.at(prefix + "HandMiddle")));
      parents.emplace_back(named.at(prefix + "ForeArm"));
    }
    joints = joint_set_of(positions, symmetric ? std::optional(Plane{Vec3f::UnitX(), 0.0f}) : std::nullopt);
    for (std::size_t j = 0; j < joints.size(); ++j)  // as of an extraction: exact images
      if (const auto partner = joints.partner[j]; partner && *partner > j) joints.positions[*partner] = mirrored(joints.positions[j]);
    tree.parents = parents;
    tree.root = static_cast<std::size_t>(std::ranges::find_if(parents, [](const auto& p) { return !p; }) - parents.begin());
  }
  void add(const Vec3f& position, const std::string& parent) {
    tree.parents.emplace_back(named.at(parent));
    joints.positions.push_back(position);
    joints.partner.emplace_back();
  }
};

std::vector<std::size_t> joints_of(const SkeletonDraft& s, HandPart part) {
  std::vector<std::size_t> out;
  for (std::size_t j = 0; j < s.part.size(); ++j)
    if (s.part[j] == part) out.push_back(j);
  return out;
}

void expect_a_tree(const SkeletonDraft& s) {
  ASSERT_EQ(s.tree.parents.size(), s.joints.size());
  ASSERT_EQ(s.joints.partner.size(), s.joints.size());
  ASSERT_EQ(s.from.size(), s.joints.size());
  ASSERT_EQ(s.part.size(), s.joints.size());
  for (std::size_t j = 0; j < s.joints.size(); ++j) {
    std::size_t steps = 0, at = j;
    while (s.tree.parents[at] && ++steps <= s.joints.size()) at = *s.tree.parents[at];
    EXPECT_EQ(at, s.tree.root);
    EXPECT_NE(s.from[j].has_value(), s.part[j].has_value());
  }
}

TEST(Hands, take_the_place_of_the_joints_within_them) {
  const Coarse coarse(fingered());
  const SkeletonDraft s = with_hands(coarse.joints, coarse.tree, fingered().mesh, true);
  expect_a_tree(s);
  EXPECT_EQ(s.joints.size(), coarse.joints.size() - 2 + 2 * (1 + 4 * 3));
  for (const char* palm : {"LeftPalm", "RightPalm"}) EXPECT_EQ(std::ranges::count(s.from, std::optional(coarse.named.at(palm))), 0);
  const auto wrists = joints_of(s, HandPart::wrist);
  ASSERT_EQ(wrists.size(), 2u);
  EXPECT_GT(s.joints.positions[wrists[0]].x(), 0.0f);
  EXPECT_EQ(s.from[*s.tree.parents[wrists[0]]], coarse.named.at("LeftForeArm"));
  EXPECT_EQ(s.from[*s.tree.parents[wrists[1]]], coarse.named.at("RightForeArm"));
  for (HandPart part : {HandPart::thumb, HandPart::index, HandPart::middle, HandPart::ring}) {
    const auto of_part = joints_of(s, part);  // left, right, left, ...
    ASSERT_EQ(of_part.size(), 6u);
    for (std::size_t k = 0; k < of_part.size(); ++k) EXPECT_EQ(s.tree.parents[of_part[k]], k < 2 ? wrists[k] : of_part[k - 2]);
  }
  EXPECT_TRUE(joints_of(s, HandPart::pinky).empty());
}

TEST(Hands, are_exact_mirror_images_left_first) {
  const Coarse coarse(fingered());
  const SkeletonDraft s = with_hands(coarse.joints, coarse.tree, fingered().mesh, true);
  for (std::size_t j = 0; j < s.joints.size(); ++j) {
    if (!s.part[j]) continue;
    ASSERT_TRUE(s.joints.partner[j]);
    const std::size_t partner = *s.joints.partner[j];
    EXPECT_EQ(s.joints.positions[partner], mirrored(s.joints.positions[j]));
    EXPECT_EQ(partner, s.joints.positions[j].x() > 0.0f ? j + 1 : j - 1);
    EXPECT_EQ(s.part[partner], s.part[j]);
  }
}

TEST(Hands, without_symmetry_each_is_found_by_itself) {
  const Coarse coarse(fingered(), false);
  const SkeletonDraft s = with_hands(coarse.joints, coarse.tree, fingered().mesh, false);
  expect_a_tree(s);
  EXPECT_EQ(joints_of(s, HandPart::wrist).size(), 2u);
  EXPECT_EQ(joints_of(s, HandPart::index).size(), 6u);
  for (const auto& partner : s.joints.partner) EXPECT_FALSE(partner);
}

TEST(Hands, a_hand_on_one_side_only_has_no_partner_unless_the_surface_is_its_image) {
  const Coarse coarse(fingered());
  TriangleMesh one_handed = fingered().mesh;
  const float wrist = fingered().at("RightHand").x();
  std::vector<Triangle> kept;
  for (const Triangle& face : one_handed.faces)
    if (std::ranges::all_of(face, [&](VertexId v) { return one_handed.positions[v].x() > wrist; })) kept.push_back(face);
  one_handed.faces = PerFace<Triangle>(kept);
  const SkeletonDraft one = with_hands(coarse.joints, coarse.tree, one_handed, false),
                      both = with_hands(coarse.joints, coarse.tree, one_handed, true);
  expect_a_tree(one);
  ASSERT_EQ(joints_of(one, HandPart::wrist).size(), 1u);
  EXPECT_FALSE(one.joints.partner[joints_of(one, HandPart::wrist)[0]]);
  EXPECT_EQ(std::ranges::count(one.from, std::optional(coarse.named.at("RightPalm"))), 1);
  EXPECT_EQ(joints_of(both, HandPart::wrist).size(), 2u);
}

TEST(Hands, what_a_hand_holds_hangs_on_it) {
  Coarse coarse(fingered());
  coarse.add(fingered().at("LeftHandMiddle") + Vec3f(0.2f, 0.2f, 0), "LeftPalm");  // the end of a sword
  const SkeletonDraft s = with_hands(coarse.joints, coarse.tree, fingered().mesh, true);
  expect_a_tree(s);
  ASSERT_EQ(joints_of(s, HandPart::wrist).size(), 2u);
  const auto sword = std::ranges::find(s.from, std::optional(coarse.joints.size() - 1)) - s.from.begin();
  EXPECT_EQ(s.tree.parents[static_cast<std::size_t>(sword)], joints_of(s, HandPart::wrist)[0]);
}

TEST(Hands, what_the_right_hand_holds_does_not_cross_them) {
  Coarse coarse(fingered());
  coarse.add(fingered().at("RightHandMiddle") + Vec3f(-0.2f, 0.2f, 0), "RightPalm");
  const SkeletonDraft s = with_hands(coarse.joints, coarse.tree, fingered().mesh, true);
  expect_a_tree(s);
  const auto wrists = joints_of(s, HandPart::wrist);
  ASSERT_EQ(wrists.size(), 2u);
  for (const std::size_t wrist : wrists) EXPECT_GT(s.joints.positions[wrist].x() * s.joints.positions[*s.tree.parents[wrist]].x(), 0.0f);
}

// A hand that hangs down lies beside the leg.
TEST(Hands, a_joint_of_another_limb_stays_however_near_it_is) {
  Coarse coarse(fingered());
  const Vec3f palm = coarse.joints.positions[coarse.named.at("LeftPalm")];
  const std::size_t knee = coarse.joints.size();
  coarse.add(palm, "LeftUpLeg");
  coarse.add(mirrored(palm), "RightUpLeg");
  coarse.joints.partner[knee] = knee + 1;
  coarse.joints.partner[knee + 1] = knee;
  const SkeletonDraft s = with_hands(coarse.joints, coarse.tree, fingered().mesh, true);
  expect_a_tree(s);
  EXPECT_EQ(joints_of(s, HandPart::wrist).size(), 2u);
  const auto kept = std::ranges::find(s.from, std::optional(knee));
  ASSERT_NE(kept, s.from.end());
  EXPECT_EQ(s.from[*s.tree.parents[static_cast<std::size_t>(kept - s.from.begin())]], coarse.named.at("LeftUpLeg"));
}

TEST(Hands, where_there_are_none_nothing_changes) {
  const FigureWithHands mitten = test::figure_with_hands(0, 1, 160);
  Coarse coarse(fingered());
  for (const SkeletonDraft& s :
       {with_hands(coarse.joints, coarse.tree, mitten.mesh, true), SkeletonDraft::of(coarse.joints, coarse.tree)}) {
    EXPECT_EQ(s.joints.positions, coarse.joints.positions);
    EXPECT_EQ(s.joints.partner, coarse.joints.partner);
    EXPECT_EQ(s.tree.parents, coarse.tree.parents);
    EXPECT_EQ(s.tree.root, coarse.tree.root);
  }
}

TEST(Hands, their_joints_are_named_by_their_part) {
  const Coarse coarse(fingered());
  const SkeletonDraft s = with_hands(coarse.joints, coarse.tree, fingered().mesh, true);
  const TreeSkeleton made = make_skeleton(s.joints, s.tree, {1.0f, Vec3f::Zero()}, false, s.part);
  validate(made.skeleton);
  for (JointId j : made.skeleton.names.ids()) {
    const auto part = s.part[made.from[j]];
    const std::string side = s.joints.positions[made.from[j]].x() > 0.0f ? "left_" : "right_";
    if (part == HandPart::wrist) EXPECT_EQ(made.skeleton.names[j], side + "hand");
    if (part == HandPart::thumb) EXPECT_TRUE(made.skeleton.names[j].starts_with(side + "thumb_"));
    if (part == HandPart::ring) EXPECT_TRUE(made.skeleton.names[j].starts_with(side + "ring_"));
    if (!part) EXPECT_EQ(made.skeleton.names[j].find("hand"), std::string::npos);
  }
}

}  // namespace
}  // namespace osteon::pipelines
