// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/joint_votes.h"

#include "osteon/geometry/neighbourhoods.h"
#include "osteon/geometry/vote_features.h"
#include "osteon/geometry/working_mesh.h"
#include "osteon/mesh/shapes.h"
#include "untrained.h"

namespace osteon::pipelines {
namespace {

using test::Network;

// A network that adds nothing leaves every vote in the middle of the body, whichever way it was shown the character.
TEST(JointVotes, of_a_silent_network_are_the_middles_of_the_body_in_all_views) {
  const infer::RignetModels silent = test::untrained_models({Network::votes, Network::tree, Network::bind}, test::LastLayer::zero);
  const TriangleMesh mesh = geometry::make_working_mesh(shapes::capsule(0.2f, 1.0f)).mesh;
  const geometry::GeodesicBalls balls = geometry::geodesic_balls(mesh);
  const geometry::Neighbourhoods ring = geometry::one_ring(mesh), near = geometry::evenly(balls, 10);
  const JointCandidates votes =
      joint_votes(mesh, infer::single_mesh(mesh.positions.raw(), {ring.offsets, ring.members}, {near.offsets, near.members}),
                  geometry::regions(mesh, balls, nets::vote_regions, 0), silent, 20.0f);
  const geometry::VoteFeatures features = geometry::vote_features(mesh);
  const std::size_t count = mesh.positions.size();
  ASSERT_EQ(votes.positions.size(), 4 * count);
  for (std::size_t i = 0; i < votes.positions.size(); ++i) {
    const auto v = static_cast<VertexId>(i % count);
    EXPECT_LT((votes.positions[i] - mesh.positions[v] - features.to_middle[v]).norm(), 1e-5f);
    EXPECT_FLOAT_EQ(votes.attention[i], 0.5f);
  }
}

TEST(ExpectedJoints, grow_with_the_triangles_and_with_the_detail_that_is_asked_for) {
  EXPECT_NEAR(expected_joints(1000, 0.5f), 13.4f, 1e-4f);
  EXPECT_NEAR(expected_joints(1000, 1.0f), 4.0f * 13.4f, 1e-3f);
  EXPECT_NEAR(expected_joints(1000, 0.0f), 13.4f / 4.0f, 1e-4f);
  EXPECT_LT(expected_joints(500, 0.5f), expected_joints(5000, 0.5f));
  EXPECT_EQ(expected_joints(10000, 0.5f), expected_joints(1000000, 0.5f));  // a scan is not a finer character
}

}  // namespace
}  // namespace osteon::pipelines
