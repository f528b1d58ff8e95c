// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/vote_features.h"

#include <gtest/gtest.h>

#include "osteon/mesh/shapes.h"
#include "osteon/nets/voting.h"

namespace osteon::geometry {
namespace {

static_assert(kVoteFeatures == nets::vote_features);

// All chords through the centre of a ball are its diameter; those 40 degrees off are cos(40) of it, and lie a little nearer to the vertex.
TEST(VoteFeatures, lead_towards_the_centre_of_a_ball) {
  const TriangleMesh ball = shapes::icosphere(3, 0.5f);
  const VoteFeatures f = vote_features(ball);
  const float chord = std::cos(40.0f * 3.14159265f / 180.0f);
  for (VertexId v : ball.positions.ids()) {
    EXPECT_NEAR(f.thicknesses[v], chord, 0.02f);
    const Vec3f expected = -ball.positions[v] * (1.0f + 6.0f * chord * chord) / 7.0f;
    EXPECT_LT((f.to_middle[v] - expected).norm(), 0.02f);
  }
}

TEST(VoteFeatures, end_on_the_axis_of_a_tube_in_its_long_part) {
  const TriangleMesh capsule = shapes::capsule(0.05f, 0.9f, 32, 16);
  const VoteFeatures f = vote_features(capsule);
  for (VertexId v : capsule.positions.ids()) {
    const Vec3f middle = capsule.positions[v] + f.to_middle[v];
    if (capsule.positions[v].y() < 0.2f || capsule.positions[v].y() > 0.7f) continue;
    EXPECT_LT(Eigen::Vector2f(middle.x(), middle.z()).norm(), 0.02f);
  }
}

// Rays that meet the outside of a face come from outside the body: they do not count.
TEST(VoteFeatures, are_zero_where_no_ray_leaves_the_body_again) {
  const TriangleMesh sheet{{Vec3f(0, 0, 0), Vec3f(1, 0, 0), Vec3f(0, 1, 0)}, {Triangle{VertexId{0}, VertexId{1}, VertexId{2}}}};
  const VoteFeatures f = vote_features(sheet);
  for (VertexId v : sheet.positions.ids()) {
    EXPECT_EQ(f.thicknesses[v], 0.0f);
    EXPECT_EQ(f.to_middle[v], Vec3f::Zero());
    EXPECT_EQ(f.normals[v], Vec3f::UnitZ());
  }
}

TEST(VoteFeatures, turn_with_the_shape) {
  const TriangleMesh box = shapes::capsule(0.1f, 0.6f, 16, 8);
  const Transform turn(Eigen::AngleAxisf(0.7f, Vec3f(1, 2, 3).normalized()));
  const VoteFeatures here = vote_features(box), there = vote_features(shapes::transformed(box, turn));
  int same = 0;
  for (VertexId v : box.positions.ids())
    if (std::abs(there.thicknesses[v] - here.thicknesses[v]) < 0.05f && (there.to_middle[v] - turn * here.to_middle[v]).norm() < 0.03f)
      ++same;
  EXPECT_GT(same, static_cast<int>(0.9 * static_cast<double>(box.positions.size())));  // the rays around the normal begin elsewhere
}

TEST(VoteRows, hold_the_features_the_level_of_detail_and_waves_of_the_middle) {
  VoteFeatures f{{Vec3f(0, 0, 1)}, {Vec3f(0.25f, 0, -0.5f)}, {0.7f}};
  const Vec3f position(0, 0.125f, 0.5f);  // the middle is (1/4, 1/8, 0)
  const std::vector<float> row = vote_rows({&position, 1}, f, std::exp(4.0f));
  ASSERT_EQ(row.size(), static_cast<std::size_t>(kVoteFeatures));
  const float half = std::sqrt(0.5f);
  const std::vector<float> expected{0, 0,  1,    0.25f, 0, -0.5f, 0.7f, 1,  // as they are
                                    1, 0,  half, half,  0, 1,               // a wave of length 1: pi/2, pi/4, 0
                                    0, -1, 1,    0,     0, 1,               // 1/2
                                    0, 1,  0,    -1,    0, 1};              // 1/4
  for (std::size_t i = 0; i < row.size(); ++i) EXPECT_NEAR(row[i], expected[i], 1e-5f) << i;
}

}  // namespace
}  // namespace osteon::geometry
