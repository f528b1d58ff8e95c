// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/joint_votes.h"

#include <filesystem>
#include <optional>

#include "osteon/geometry/neighbourhoods.h"
#include "osteon/geometry/vote_features.h"
#include "osteon/geometry/working_mesh.h"
#include "osteon/mesh/shapes.h"
#include "untrained.h"

namespace osteon::pipelines {
namespace {

using test::Network;

JointCandidates votes_on(const TriangleMesh& mesh, const infer::RignetModels& models) {
  const geometry::GeodesicBalls balls = geometry::geodesic_balls(mesh);
  const geometry::Neighbourhoods ring = geometry::one_ring(mesh), near = geometry::evenly(balls, 10);
  return joint_votes(mesh, infer::single_mesh(mesh.positions.raw(), {ring.offsets, ring.members}, {near.offsets, near.members}),
                     geometry::regions(mesh, balls, nets::vote_regions, 0), models, 20.0f);
}

// A network that adds nothing leaves every vote in the middle of the body, whichever way it was shown the character.
TEST(JointVotes, of_a_silent_network_are_the_middles_of_the_body_in_all_views) {
  const infer::RignetModels silent = test::untrained_models({Network::votes, Network::tree, Network::bind}, test::LastLayer::zero);
  const TriangleMesh mesh = geometry::make_working_mesh(shapes::capsule(0.2f, 1.0f)).mesh;
  const JointCandidates votes = votes_on(mesh, silent);
  const geometry::VoteFeatures features = geometry::vote_features(mesh);
  const std::size_t count = mesh.positions.size();
  ASSERT_EQ(votes.positions.size(), 4 * count);
  for (std::size_t i = 0; i < votes.positions.size(); ++i) {
    const auto v = static_cast<VertexId>(i % count);
    EXPECT_LT((votes.positions[i] - mesh.positions[v] - features.to_middle[v]).norm(), 1e-5f);
    EXPECT_FLOAT_EQ(votes.attention[i], 0.5f);
  }
}

// Three folders of weights: voting network a alone, b alone, and a with b as the second.
TEST(JointVotes, of_two_networks_are_the_first_ones_from_the_front_and_the_second_ones_from_behind) {
  const test::TemporaryFolder folder;
  const auto with = [&](const char* name, std::uint64_t first, std::optional<std::uint64_t> second) {
    const auto models = folder / name;
    std::filesystem::create_directories(models);
    save_safetensors(models / "votes.safetensors", test::random_parameters(Network::votes, first));
    if (second) save_safetensors(models / "second_votes.safetensors", test::random_parameters(Network::votes, *second));
    save_safetensors(models / "tree.safetensors", test::random_parameters(Network::tree, 3));
    save_safetensors(models / "bind.safetensors", test::random_parameters(Network::bind, 4));
    return infer::RignetModels::load(models);
  };
  const TriangleMesh mesh = geometry::make_working_mesh(shapes::capsule(0.2f, 1.0f)).mesh;
  const auto both = with("both", 1, 2);
  EXPECT_EQ(both.voters(), 2);
  const JointCandidates a = votes_on(mesh, with("a", 1, {})), b = votes_on(mesh, with("b", 2, {})), heard = votes_on(mesh, both);
  ASSERT_EQ(heard.positions.size(), 4 * mesh.positions.size());
  for (std::size_t i = 0; i < heard.positions.size(); ++i) {
    const JointCandidates& expected = i < 2 * mesh.positions.size() ? a : b;
    ASSERT_EQ(heard.positions[i], expected.positions[i]) << i;
    ASSERT_EQ(heard.attention[i], expected.attention[i]) << i;
    ASSERT_NE(a.attention[i], b.attention[i]) << i;
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
