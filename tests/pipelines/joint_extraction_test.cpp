// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/joint_extraction.h"

#include <algorithm>
#include <numbers>

#include "osteon/base/random.h"
#include "osteon/mesh/shapes.h"
#include "support/expect.h"

namespace osteon::pipelines {
namespace {

const Plane kMiddle{Vec3f::UnitX(), 0.0f};

// A body of width 1, height 1, depth 0.3 on the ground, in which all joints below lie.
const geometry::VoxelGrid& body() {
  static const geometry::VoxelGrid grid =
      geometry::voxelize(shapes::transformed(shapes::box({1, 1, 0.3f}), Transform(Eigen::Translation3f(0, 0.5f, 0))), 40);
  return grid;
}

// A stick figure: three joints on the plane, five mirror pairs.
std::vector<Vec3f> figure() {
  std::vector<Vec3f> joints{{0, 0.5f, 0}, {0, 0.65f, 0.01f}, {0, 0.9f, 0}};
  for (const Vec3f& p :
       {Vec3f(0.1f, 0.45f, 0), Vec3f(0.12f, 0.25f, 0.02f), Vec3f(0.12f, 0.05f, 0), Vec3f(0.2f, 0.75f, 0), Vec3f(0.42f, 0.75f, 0)}) {
    joints.push_back(p);
    joints.push_back(mirrored(p));
  }
  return joints;
}

JointCandidates candidates_around(const std::vector<Vec3f>& joints, int each, float sigma, std::uint64_t seed) {
  Random random(seed);
  JointCandidates out;
  for (const Vec3f& p : joints)
    for (int k = 0; k < each; ++k) {
      out.positions.push_back(p + sigma * Vec3f(random.normal(), random.normal(), random.normal()));
      out.attention.push_back(random.uniform(0.3f, 1.0f));
    }
  return out;
}

float distance_to_nearest(const Vec3f& p, const std::vector<Vec3f>& all) {
  float least = 1e9f;
  for (const Vec3f& q : all) least = std::min(least, (p - q).norm());
  return least;
}

void expect_exactly_symmetric(const JointSet& joints) {
  for (std::size_t j = 0; j < joints.size(); ++j) {
    ASSERT_TRUE(joints.partner[j].has_value());
    const std::size_t partner = *joints.partner[j];
    EXPECT_EQ(*joints.partner[partner], j);
    EXPECT_EQ(joints.positions[partner], mirrored(joints.positions[j]));
    if (partner != j) {
      EXPECT_EQ(std::max(partner, j) - std::min(partner, j), 1u);
      EXPECT_GT(joints.positions[std::min(partner, j)].x(), 0.0f);
    }
  }
}

TEST(JointExtraction, finds_every_joint_among_noise_and_no_other) {
  for (std::uint64_t seed : {1, 2, 3}) {
    const auto found = extract_joints(candidates_around(figure(), 90, 0.012f, seed), body(), kMiddle);
    EXPECT_EQ(found.joints.size(), figure().size());
    for (const Vec3f& p : figure()) EXPECT_LT(distance_to_nearest(p, found.joints.normalised()), 0.01f);
    EXPECT_GT(found.explained, 0.98f);
    expect_exactly_symmetric(found.joints);
  }
}

TEST(JointExtraction, without_symmetry_each_joint_stands_for_itself) {
  const auto found = extract_joints(candidates_around(figure(), 90, 0.012f, 4), body(), std::nullopt);
  EXPECT_EQ(found.joints.size(), figure().size());
  for (const Vec3f& p : figure()) EXPECT_LT(distance_to_nearest(p, found.joints.normalised()), 0.02f);
  EXPECT_TRUE(std::ranges::none_of(found.joints.partner, [](const auto& p) { return p.has_value(); }));
}

TEST(JointExtraction, both_sides_vote_for_a_pair) {
  // The left arm is seen 0.02 too high, the right one 0.02 too low.
  JointCandidates seen = candidates_around({{0, 0.5f, 0}, {0.3f, 0.72f, 0}, {-0.3f, 0.68f, 0}}, 200, 0.005f, 5);
  const auto found = extract_joints(seen, body(), kMiddle, {.bandwidth = 0.035f});
  ASSERT_EQ(found.joints.size(), 3u);
  EXPECT_LT(distance_to_nearest({0.3f, 0.7f, 0}, found.joints.positions), 0.004f);
  expect_exactly_symmetric(found.joints);
}

TEST(JointExtraction, a_joint_seen_on_one_side_stays_alone_only_where_the_other_side_has_no_body) {
  const TriangleMesh torso = shapes::transformed(shapes::box({1, 1, 0.3f}), Transform(Eigen::Translation3f(0, 0.5f, 0)));
  const TriangleMesh blade = shapes::box({0.1f, 1, 0.1f});
  for (float side : {1.0f, -1.0f}) {
    const auto armed =
        geometry::voxelize(shapes::merged(torso, shapes::transformed(blade, Transform(Eigen::Translation3f(side * 0.8f, 0.7f, 0)))));
    const auto seen = candidates_around({{0, 0.5f, 0}, {side * 0.3f, 0.7f, 0}, {side * 0.8f, 0.7f, 0}}, 100, 0.008f, 6);
    const auto found = extract_joints(seen, armed, kMiddle);
    ASSERT_EQ(found.joints.size(), 4u);
    EXPECT_LT(distance_to_nearest({side * 0.8f, 0.7f, 0}, found.joints.positions), 0.01f);
    EXPECT_GT(distance_to_nearest({-side * 0.8f, 0.7f, 0}, found.joints.positions), 0.4f);
    EXPECT_LT(distance_to_nearest({-side * 0.3f, 0.7f, 0}, found.joints.positions), 0.01f);
  }
}

TEST(JointExtraction, a_turned_and_shifted_plane_gives_the_turned_joints) {
  const Transform turn = Eigen::Translation3f(0.03f, 0, -0.02f) * Eigen::AngleAxisf(0.3f, Vec3f::UnitY());
  JointCandidates seen = candidates_around(figure(), 90, 0.012f, 7);
  const auto straight = extract_joints(seen, body(), kMiddle);
  for (Vec3f& p : seen.positions) p = turn * p;
  const Vec3f normal = turn.linear() * Vec3f::UnitX();
  const auto turned_body =
      geometry::voxelize(shapes::transformed(shapes::box({1, 1, 0.3f}), turn * Transform(Eigen::Translation3f(0, 0.5f, 0))), 40);
  const auto turned = extract_joints(seen, turned_body, Plane{-normal, -normal.dot(turn.translation())});
  ASSERT_EQ(turned.joints.size(), straight.joints.size());
  expect_exactly_symmetric(turned.joints);
  for (const Vec3f& p : straight.joints.normalised()) EXPECT_LT(distance_to_nearest(turn * p, turned.joints.normalised()), 2e-3f);
}

TEST(JointExtraction, the_number_of_vertices_does_not_change_the_joints) {
  const auto few = extract_joints(candidates_around(figure(), 60, 0.01f, 8), body(), kMiddle);
  const auto many = extract_joints(candidates_around(figure(), 400, 0.01f, 9), body(), kMiddle);
  EXPECT_EQ(few.joints.size(), many.joints.size());
}

TEST(JointExtraction, candidates_outside_or_without_attention_are_not_heard) {
  JointCandidates seen = candidates_around(figure(), 60, 0.01f, 10);
  const std::size_t joints = extract_joints(seen, body(), kMiddle).joints.size();
  for (int k = 0; k < 500; ++k) {
    seen.positions.emplace_back(0.3f, 0.4f, 0.3f);  // in front of the body
    seen.attention.push_back(1.0f);
    seen.positions.emplace_back(0.3f, 0.4f, 0.0f);  // in the body, but not attended to
    seen.attention.push_back(5e-4f);
    seen.positions.emplace_back(NAN, 0.4f, 0.0f);
    seen.attention.push_back(1.0f);
  }
  const auto found = extract_joints(seen, body(), kMiddle);
  EXPECT_EQ(found.joints.size(), joints);
  EXPECT_TRUE(found.inside_used);
}

TEST(JointExtraction, where_there_is_no_volume_the_inside_test_is_left_out) {
  const auto found = extract_joints(candidates_around(figure(), 60, 0.01f, 11), geometry::VoxelGrid{}, kMiddle);
  EXPECT_FALSE(found.inside_used);
  EXPECT_EQ(found.joints.size(), figure().size());
}

// Two joints that the votes agree on and one between them, in whose place they are spread over 0.1.
TEST(JointExtraction, a_joint_whose_votes_are_spread_is_found_with_twice_the_bandwidth) {
  JointCandidates seen;
  for (int i = 0; i < 400; ++i)
    for (const float y : {0.2f, 0.9f}) seen.positions.emplace_back(0.0f, y, 1e-5f * static_cast<float>(i));
  for (int i = 0; i < 60; ++i) seen.positions.emplace_back(0.0f, 0.5f + 0.1f * static_cast<float>(i) / 59.0f, 0.0f);
  seen.attention.assign(seen.positions.size(), 1.0f);
  const auto found = [&](float spread_share) {
    return extract_joints(seen, geometry::VoxelGrid{}, std::nullopt, {.min_share = 0.05f, .spread_share = spread_share}).joints;
  };
  EXPECT_EQ(found(1.0f).size(), 2u);
  const JointSet joints = found(0.02f);
  ASSERT_EQ(joints.size(), 3u);
  EXPECT_NEAR(joints.positions.back().y(), 0.55f, 0.02f);
}

// All agree on a joint at x = -0.3 and on another; votes for a third are spread around x = 0.3, which has no mirror image without symmetry.
TEST(JointExtraction, without_symmetry_a_joint_may_be_spread_at_the_mirror_image_of_another) {
  JointCandidates seen;
  for (int i = 0; i < 400; ++i)
    for (const Vec3f& p : {Vec3f(-0.3f, 0.5f, 0.0f), Vec3f(0.0f, 0.9f, 0.0f)})
      seen.positions.push_back(p + 1e-5f * static_cast<float>(i) * Vec3f::UnitZ());
  for (int i = 0; i < 60; ++i) seen.positions.emplace_back(0.3f, 0.46f + 0.08f * static_cast<float>(i) / 59.0f, 0.0f);
  seen.attention.assign(seen.positions.size(), 1.0f);
  const JointSet joints = extract_joints(seen, geometry::VoxelGrid{}, std::nullopt, {.min_share = 0.1f, .spread_share = 0.02f}).joints;
  ASSERT_EQ(joints.size(), 3u);
  EXPECT_NEAR((joints.positions.back() - Vec3f(0.3f, 0.5f, 0.0f)).norm(), 0.0f, 0.02f);
}

TEST(JointExtraction, nothing_attended_to_gives_no_joints) {
  JointCandidates seen = candidates_around(figure(), 20, 0.01f, 12);
  std::ranges::fill(seen.attention, 0.0f);
  EXPECT_EQ(extract_joints(seen, body(), kMiddle).joints.size(), 0u);
  EXPECT_EQ(extract_joint_count(seen, body(), kMiddle, 5).joints.size(), 0u);
  EXPECT_EQ(extract_joints({}, body(), std::nullopt).joints.size(), 0u);
}

TEST(JointExtraction, detail_runs_from_the_coarsest_to_the_finest_bandwidth) {
  EXPECT_FLOAT_EQ(bandwidth_of_detail(0.0f), kCoarsestBandwidth);
  EXPECT_FLOAT_EQ(bandwidth_of_detail(0.5f), kDefaultBandwidth);
  EXPECT_FLOAT_EQ(bandwidth_of_detail(1.0f), kFinestBandwidth);
  const JointCandidates seen = candidates_around(figure(), 90, 0.03f, 13);
  std::size_t before = 0;
  for (float detail : {0.0f, 0.5f, 1.0f}) {
    const std::size_t joints = extract_joints(seen, body(), kMiddle, {.bandwidth = bandwidth_of_detail(detail)}).joints.size();
    EXPECT_GT(joints, before);
    before = joints;
  }
}

TEST(JointExtraction, a_wanted_number_of_joints_is_found_by_the_bandwidth) {
  const JointCandidates seen = candidates_around(figure(), 90, 0.03f, 13);
  for (std::size_t wanted : {13u, 19u, 25u}) {
    const auto found = extract_joint_count(seen, body(), kMiddle, wanted);
    EXPECT_NEAR(static_cast<double>(found.joints.size()), static_cast<double>(wanted), 1.0) << "pairs come two at a time";
  }
}

}  // namespace
}  // namespace osteon::pipelines
