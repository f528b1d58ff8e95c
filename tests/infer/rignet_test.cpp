// SPDX-License-Identifier: Apache-2.0
#include "osteon/infer/rignet.h"

#include <thread>

#include "examples.h"
#include "support/expect.h"

namespace osteon::infer {
namespace {

using test::Network;
using testing::HasSubstr;

// Models with seeded weights, written to and read from files.
RignetModels models_with(std::initializer_list<Network> networks) {
  const test::TemporaryFolder folder;
  for (const Network network : networks)
    save_safetensors(folder / (std::string(nets::rignet::name_of(network)) + ".safetensors"),
                     test::random_weights(nets::rignet::parameter_shapes(network), 1));
  return RignetModels::load(folder.path());
}

const RignetModels& models() {
  static const RignetModels loaded = models_with({Network::votes, Network::tree, Network::bind});
  return loaded;
}

const RignetModels& paper_models() {
  static const RignetModels loaded = models_with({Network::joints, Network::attention, Network::bones, Network::root, Network::skin});
  return loaded;
}

Matrix matrix_of(const std::vector<float>& values, Eigen::Index columns) {
  return Eigen::Map<const Matrix>(values.data(), static_cast<Eigen::Index>(values.size()) / columns, columns);
}

TEST(RignetModels, attention_and_probabilities_lie_between_0_and_1) {
  const test::ExampleInput input = test::one_mesh(120, 7, 2);
  for (const RignetModels* model : {&models(), &paper_models()}) {
    const JointVotes votes = model->votes(input.mesh, input.votes);
    EXPECT_EQ(votes.attention.rows(), 120);
    EXPECT_EQ(votes.attention.cols(), 1);
    EXPECT_GE(votes.attention.minCoeff(), 0);
    EXPECT_LE(votes.attention.maxCoeff(), 1);
    EXPECT_EQ(votes.displacement.rows(), 120);
    EXPECT_EQ(votes.displacement.cols(), 3);
  }
  ASSERT_FALSE(paper_models().finds_parents());
  const Matrix bones = paper_models().bone_probabilities(input.mesh, input.joints, matrix_of(input.pairs.features, 8));
  EXPECT_EQ(bones.rows(), 21);
  EXPECT_GE(bones.minCoeff(), 0);
  EXPECT_LE(bones.maxCoeff(), 1);
  const Matrix roots = paper_models().root_probabilities(input.mesh, input.joints);
  EXPECT_EQ(roots.rows(), 7);
  EXPECT_NEAR(roots.sum(), 1, 1e-5f);
}

TEST(RignetModels, every_joint_has_one_parent_or_is_the_root) {
  const test::ExampleInput input = test::one_mesh(20, 7, 2);
  ASSERT_TRUE(models().finds_parents());
  const Matrix parents = models().parent_probabilities(input.joints, input.tree);
  ASSERT_EQ(parents.rows(), 7);
  ASSERT_EQ(parents.cols(), 7);
  EXPECT_GT(parents.minCoeff(), 0);
  EXPECT_TRUE(parents.rowwise().sum().isApproxToConstant(1.0f, 1e-5f));
}

TEST(RignetModels, a_bone_is_as_likely_from_either_of_its_ends) {
  test::ExampleInput input = test::one_mesh(60, 2, 3);
  const Matrix before = paper_models().bone_probabilities(input.mesh, input.joints, matrix_of(input.pairs.features, 8));
  std::swap_ranges(input.joints.positions.begin(), input.joints.positions.begin() + 3, input.joints.positions.begin() + 3);
  std::swap_ranges(input.pairs.features.begin(), input.pairs.features.begin() + 3, input.pairs.features.begin() + 3);
  const Matrix after = paper_models().bone_probabilities(input.mesh, input.joints, matrix_of(input.pairs.features, 8));
  EXPECT_NEAR(before(0, 0), after(0, 0), 1e-6f);
}

TEST(RignetModels, a_single_joint_has_no_pairs_and_is_the_root) {
  const test::ExampleInput input = test::one_mesh(30, 1, 4);
  EXPECT_EQ(models().parent_probabilities(input.joints, input.tree)(0, 0), 1);
  EXPECT_EQ(paper_models().bone_probabilities(input.mesh, input.joints, Matrix(0, 8)).rows(), 0);
  EXPECT_EQ(paper_models().root_probabilities(input.mesh, input.joints)(0, 0), 1);
}

TEST(RignetModels, skin_weights_sum_to_1_over_the_bones_that_there_are) {
  const test::ExampleInput input = test::one_mesh(50, 2, 5);
  Eigen::Matrix<int, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> nearest(50, 5);
  nearest.rowwise() = Eigen::Matrix<int, 1, 5>(2, 0, 1, -1, -1);
  EXPECT_FALSE(paper_models().binds());
  const Matrix weights = paper_models().skin_weights(input.mesh, matrix_of(input.skin_features, 43), nearest);
  EXPECT_TRUE((weights.rightCols(2).array() == 0).all());
  for (Eigen::Index v = 0; v < 50; ++v) EXPECT_NEAR(weights.row(v).sum(), 1, 1e-6f);
}

TEST(RignetModels, bind_weights_sum_to_1_over_the_choices_of_a_vertex) {
  const test::ExampleInput input = test::one_mesh(50, 2, 5);
  ASSERT_TRUE(models().binds());
  const Matrix weights = models().bind_weights(input.mesh, input.choices, 8);
  for (Eigen::Index v = 0; v < 50; ++v) {
    const std::int32_t count = input.choices.offsets[static_cast<std::size_t>(v) + 1] - input.choices.offsets[static_cast<std::size_t>(v)];
    EXPECT_NEAR(weights.row(v).head(count).sum(), 1, 1e-6f);
    EXPECT_TRUE((weights.row(v).tail(8 - count).array() == 0).all());
  }
}

TEST(RignetModels, may_be_used_by_two_threads_at_once) {
  const test::ExampleInput input = test::one_mesh(100, 3, 6);
  const Matrix expected = models().votes(input.mesh, input.votes).displacement;
  Matrix other;
  std::thread thread([&] { other = models().votes(input.mesh, input.votes).displacement; });
  const Matrix own = models().votes(input.mesh, input.votes).displacement;
  thread.join();
  EXPECT_TRUE(test::same_bits(own, expected));
  EXPECT_TRUE(test::same_bits(other, expected));
}

TEST(RignetModels, every_missing_file_is_named) {
  const test::TemporaryFolder folder;
  save_safetensors(folder / "tree.safetensors", {});
  const std::string error = test::error_of([&] { RignetModels::load(folder.path()); });
  for (const char* name : {"votes", "bind"}) EXPECT_THAT(error, HasSubstr((folder / name).string() + ".safetensors"));
  EXPECT_THAT(error, testing::Not(HasSubstr("tree.safetensors")));
}

TEST(SingleMesh, every_vertex_hears_itself_first) {
  const std::vector<Vec3f> positions(3, Vec3f::Ones());
  const std::vector<std::uint32_t> offsets{0, 2, 2, 3}, members{1, 2, 0};
  const nets::MeshArrays mesh = single_mesh(positions, {offsets, members}, {offsets, members});
  EXPECT_EQ(mesh.ring.offsets, (std::vector<std::int32_t>{0, 3, 4, 6}));
  EXPECT_EQ(mesh.ring.sources, (std::vector<std::int32_t>{0, 1, 2, 1, 2, 0}));
  EXPECT_EQ(mesh.ring.receivers, (std::vector<std::int32_t>{0, 0, 0, 1, 2, 2}));
}

}  // namespace
}  // namespace osteon::infer
