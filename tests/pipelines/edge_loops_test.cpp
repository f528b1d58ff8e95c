// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/edge_loops.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "osteon/base/random.h"
#include "support/expect.h"

namespace osteon::pipelines {
namespace {

constexpr std::size_t kMoving = 1;  // of the chains below

// Joints one after the other, each the parent of the next.
JointTree chain(std::size_t joints) {
  JointTree tree;
  tree.parents.push_back(std::nullopt);
  for (std::size_t j = 1; j < joints; ++j) tree.parents.emplace_back(j - 1);
  return tree;
}

JointSet arm(float x = 0.3f, float at = 0.5f) {
  return joint_set_of(std::vector<Vec3f>{{x, 0.3f, 0}, {x, at, 0}, {x, 0.8f, 0}}, std::nullopt);
}

// Circles of twelve vertices about a vertical axis.
std::vector<Vec3f> rings(const std::vector<float>& heights, float x = 0.3f, float radius = 0.04f) {
  std::vector<Vec3f> out;
  for (float y : heights)
    for (int k = 0; k < 12; ++k) {
      const float angle = std::numbers::pi_v<float> * static_cast<float>(k) / 6.0f;
      out.emplace_back(x + radius * std::cos(angle), y, radius * std::sin(angle));
    }
  return out;
}

// One in every 0.025, and three close together.
std::vector<float> evenly_with_loops_at(float middle) {
  std::vector<float> heights{middle - 0.006f, middle, middle + 0.006f};
  for (int k = 0; k <= 40; ++k) heights.push_back(0.025f * static_cast<float>(k));
  return heights;
}

TEST(EdgeLoops, a_joint_moves_along_its_limb_towards_loops_on_either_side) {
  for (const float loops : {0.475f, 0.525f}) {
    const JointSet found = drawn_to_edge_loops(arm(), chain(3), rings(evenly_with_loops_at(loops)));
    const Vec3f moved = found.positions[kMoving];
    EXPECT_GT(std::abs(moved.y() - 0.5f), 0.008f);
    EXPECT_LT(std::abs(moved.y() - loops), 0.017f);
    EXPECT_EQ(moved.x(), 0.3f);
    EXPECT_EQ(moved.z(), 0.0f);
  }
}

// The definition in the header, vertex by vertex and in double.
double defined_place(const std::vector<Vec3f>& vertices, double joint, const EdgeLoopOptions& options) {
  const auto density = [&](double y, double h) {
    double sum = 0.0;
    for (const Vec3f& p : vertices) sum += std::exp(-0.5 * std::pow((static_cast<double>(p.y()) - y) / h, 2));
    return sum / (h * std::sqrt(2.0 * std::numbers::pi)) + static_cast<double>(options.faint);
  };
  double moment = 0.0, mass = 0.0;
  for (double s = -0.06; s <= 0.06; s += 0.0005) {
    const double likely = std::exp(-0.5 * std::pow(s / static_cast<double>(options.reach), 2)) *
                          std::pow(density(joint + s, options.loop) / density(joint + s, options.limb), options.trust);
    moment += s * likely;
    mass += likely;
  }
  return joint + moment / mass;
}

TEST(EdgeLoops, the_place_is_the_mean_that_is_defined) {
  Random random(3);
  for (int round = 0; round < 20; ++round) {
    std::vector<float> heights;
    for (int k = 0; k < 60; ++k) heights.push_back(random.uniform(0.3f, 0.8f));
    const auto vertices = rings(heights);
    const JointSet found = drawn_to_edge_loops(arm(), chain(3), vertices);
    EXPECT_NEAR(static_cast<double>(found.positions[kMoving].y()), defined_place(vertices, 0.5, {}), 3e-4);
  }
}

TEST(EdgeLoops, an_even_limb_leaves_its_joint) {
  std::vector<float> heights;
  for (int k = 0; k <= 200; ++k) heights.push_back(0.005f * static_cast<float>(k));
  for (const float at : {0.45f, 0.5f, 0.613f}) {
    const JointSet found = drawn_to_edge_loops(arm(0.3f, at), chain(3), rings(heights));
    EXPECT_NEAR(found.positions[kMoving].y(), at, 2e-4f);
  }
}

TEST(EdgeLoops, what_is_far_from_the_axis_does_not_count) {
  const auto limb = rings(evenly_with_loops_at(0.525f));
  auto with_another = limb;
  for (const Vec3f& p : rings(evenly_with_loops_at(0.48f), -0.1f)) with_another.push_back(p);
  EXPECT_EQ(drawn_to_edge_loops(arm(), chain(3), limb).positions[kMoving],
            drawn_to_edge_loops(arm(), chain(3), with_another).positions[kMoving]);
}

TEST(EdgeLoops, ends_short_bones_and_sharp_bends_stay) {
  const auto vertices = rings(evenly_with_loops_at(0.52f));
  const auto expect_unmoved = [&](const std::vector<Vec3f>& joints) {
    const JointSet set = joint_set_of(joints, std::nullopt);
    EXPECT_EQ(drawn_to_edge_loops(set, chain(joints.size()), vertices).positions, set.positions);
  };
  expect_unmoved({{0.3f, 0.5f, 0}});
  expect_unmoved({{0.3f, 0.3f, 0}, {0.3f, 0.5f, 0}});
  expect_unmoved({{0.3f, 0.48f, 0}, {0.3f, 0.5f, 0}, {0.3f, 0.8f, 0}});
  expect_unmoved({{0.3f, 0.3f, 0}, {0.3f, 0.5f, 0}, {0.3f, 0.5f, 0}});
  expect_unmoved({{0.3f, 0.3f, 0}, {0.3f, 0.5f, 0}, {0.4f, 0.45f, 0}});
}

TEST(EdgeLoops, no_joint_goes_past_the_middle_of_its_bones) {
  const JointSet joints = joint_set_of(std::vector<Vec3f>{{0.3f, 0.45f, 0}, {0.3f, 0.5f, 0}, {0.3f, 0.55f, 0}}, std::nullopt);
  Random random(7);
  float farthest = 0.0f;
  for (int round = 0; round < 20; ++round) {
    const auto vertices = rings({random.uniform(0.4f, 0.6f), random.uniform(0.4f, 0.6f), random.uniform(0.4f, 0.6f)});
    const auto found = drawn_to_edge_loops(joints, chain(3), vertices, {.reach = 1.0f, .trust = 50.0f});
    farthest = std::max(farthest, std::abs(found.positions[kMoving].y() - 0.5f));
  }
  EXPECT_GT(farthest, 0.02f);
  EXPECT_LE(farthest, 0.025f + 1e-6f);
}

// A spine on the plane and two arms that hang on it.
struct ThreeLimbs {
  JointSet joints;
  JointTree tree;
  std::vector<Vec3f> vertices;
};

ThreeLimbs three_limbs() {
  ThreeLimbs out;
  out.joints = joint_set_of(std::vector<Vec3f>{{0, 0.2f, 0},
                                               {0, 0.5f, 0.02f},
                                               {0, 0.8f, 0},
                                               {0.3f, 0.8f, 0},
                                               {-0.3f, 0.8f, 0},
                                               {0.3f, 0.5f, 0.01f},
                                               {-0.3f, 0.5f, 0.01f},
                                               {0.3f, 0.2f, 0},
                                               {-0.3f, 0.2f, 0}},
                            Plane{Vec3f::UnitX(), 0.0f});
  out.tree.parents = {std::nullopt, 0, 1, 2, 2, 3, 4, 5, 6};
  for (const float x : {0.0f, 0.3f, -0.3f})
    for (const Vec3f& p : rings(evenly_with_loops_at(x < 0.0f ? 0.53f : 0.51f), x)) out.vertices.push_back(p);
  return out;
}

TEST(EdgeLoops, partners_stay_mirror_images_and_hear_both_sides) {
  const auto [joints, tree, vertices] = three_limbs();
  const JointSet found = drawn_to_edge_loops(joints, tree, vertices);
  for (std::size_t j = 0; j < found.size(); ++j) EXPECT_EQ(found.positions[*found.partner[j]], mirrored(found.positions[j]));
  EXPECT_NE(found.positions[1], joints.positions[1]);
  EXPECT_EQ(found.positions[1].x(), 0.0f);
  // Loops at 0.51 on the left and at 0.53 on the right: between what either alone would say.
  const auto place = [&](float x, float loops) {
    return drawn_to_edge_loops(arm(x), chain(3), rings(evenly_with_loops_at(loops), x)).positions[kMoving].y();
  };
  EXPECT_GT(found.positions[5].y(), place(0.3f, 0.51f));
  EXPECT_LT(found.positions[5].y(), place(0.3f, 0.53f));
}

TEST(EdgeLoops, a_turned_body_gets_turned_joints) {
  const auto [joints, tree, vertices] = three_limbs();
  const Plane plane{Vec3f(1, 0, 2).normalized(), 0.1f};
  JointSet turned = joints;
  turned.frame = MirrorFrame::of(plane);
  std::vector<Vec3f> there;
  for (const Vec3f& p : vertices) there.push_back(turned.frame.from(p));
  const JointSet found = drawn_to_edge_loops(joints, tree, vertices), found_there = drawn_to_edge_loops(turned, tree, there);
  for (std::size_t j = 0; j < joints.size(); ++j) EXPECT_LT((found.positions[j] - found_there.positions[j]).norm(), 1e-5f);
}

}  // namespace
}  // namespace osteon::pipelines
