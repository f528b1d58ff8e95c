// SPDX-License-Identifier: Apache-2.0
// Fifty characters, with the weights that are shipped: what comes out depends on the shape and on nothing else.
#include <numeric>

#include "osteon/base/random.h"
#include "osteon/infer/model_folder.h"
#include "osteon/pipelines/rignet.h"
#include "osteon/program.h"
#include "osteon/synth/character.h"
#include "osteon/tensor/precision.h"
#include "support/numbers.h"

namespace osteon {
namespace {

using pipelines::RignetResult;

constexpr std::size_t kCharacters = 50;

class Determinism : public testing::TestWithParam<tensor::Precision> {
 protected:
  void SetUp() override {
    if (!std::getenv("OSTEON_MODELS") && !std::filesystem::exists(OSTEON_MODELS_FOLDER "/rignet"))
      GTEST_SKIP() << "models/rignet is not there";
    if (GetParam() == tensor::Precision::bf16 && !tensor::has_bf16()) GTEST_SKIP() << "this processor does not multiply bf16";
  }

  static infer::RignetModels models() {
    const auto folder = std::getenv("OSTEON_MODELS") ? infer::find_models("rignet") : std::filesystem::path(OSTEON_MODELS_FOLDER "/rignet");
    return infer::RignetModels::load(folder, GetParam());
  }
  static TriangleMesh character(std::size_t i) {
    const synth::Kind kind = synth::kKinds[i % synth::kKinds.size()];
    return synth::make_character(kind, 1 + i / synth::kKinds.size(), {32, synth::Finish::BySeed}).mesh;
  }
};

// The mesh with vertex v become vertex place[v], and its faces in another order.
TriangleMesh renumbered(const TriangleMesh& mesh, const std::vector<std::size_t>& place, Random& random) {
  TriangleMesh out = mesh;
  for (std::size_t v = 0; v < place.size(); ++v) out.positions.raw()[place[v]] = mesh.positions.raw()[v];
  for (Triangle& face : out.faces)
    for (VertexId& corner : face) corner = static_cast<VertexId>(place[index(corner)]);
  random.shuffle(std::span(out.faces.raw()));
  return out;
}

void expect_same_skeleton(const Skeleton& a, const Skeleton& b, std::size_t character) {
  EXPECT_EQ(a.names, b.names) << character;
  EXPECT_EQ(a.parents, b.parents) << character;
  EXPECT_EQ(a.rest_positions, b.rest_positions) << character;
}

TEST_P(Determinism, one_two_and_four_threads_give_the_same_bits) {
  const auto networks = models();
  for (std::size_t i = 0; i < kCharacters; ++i) {
    const TriangleMesh mesh = character(i);
    const auto with = [&](int threads) {
      const test::ScopedThreads scope(threads);
      return pipelines::rig_character(mesh, networks, {});
    };
    const RignetResult one = with(1);
    for (const int threads : {2, 4}) {
      const RignetResult other = with(threads);
      expect_same_skeleton(other.skeleton, one.skeleton, i);
      EXPECT_TRUE(other.weights == one.weights) << i << ", " << threads << " threads";
    }
  }
}

TEST_P(Determinism, vertices_and_faces_in_any_order_give_the_same_rig) {
  const auto networks = models();
  Random random(11);
  for (std::size_t i = 0; i < kCharacters; ++i) {
    const TriangleMesh mesh = character(i);
    std::vector<std::size_t> place(mesh.positions.size());
    std::iota(place.begin(), place.end(), std::size_t{0});
    random.shuffle(std::span(place));
    const RignetResult plain = pipelines::rig_character(mesh, networks, {});
    const RignetResult other = pipelines::rig_character(renumbered(mesh, place, random), networks, {});
    expect_same_skeleton(other.skeleton, plain.skeleton, i);
    std::size_t different = 0;
    for (std::size_t v = 0; v < place.size(); ++v)
      different += !std::ranges::equal(plain.weights[static_cast<VertexId>(v)], other.weights[static_cast<VertexId>(place[v])]);
    EXPECT_EQ(different, 0u) << i << ": vertices with other weights";
  }
}

INSTANTIATE_TEST_SUITE_P(InBoth, Determinism, testing::Values(tensor::Precision::f32, tensor::Precision::bf16),
                         [](const auto& which) { return std::string(which.param == tensor::Precision::f32 ? "f32" : "bf16"); });

}  // namespace
}  // namespace osteon
