// SPDX-License-Identifier: Apache-2.0
#include "osteon/dataset/neuro.h"

#include <gtest/gtest.h>

#include <numeric>

#include "osteon/synth/character.h"

namespace osteon::dataset {
namespace {

// Two characters of the generator and a super skeleton of theirs.
struct Corpus {
  std::vector<Example> examples;
  BatchOptions options;

  explicit Corpus(Parts parts) {
    PrepareOptions prepare_options;
    prepare_options.working_mesh = {300, 200, 5000};
    std::vector<PreparedCharacter> characters;
    for (const synth::Kind kind : {synth::Kind::Biped, synth::Kind::Quadruped}) {
      const std::string name(synth::name(kind));
      characters.push_back(prepare(synth::make_character(kind, 1, {.cells = 32}), {name, name, name}, prepare_options));
    }
    examples = examples_of(std::move(characters), parts);
    std::vector<skin::NamedSkeleton> skeletons;
    for (const Example& e : examples) skeletons.push_back({&e.character.skeleton, e.character.info.group});
    options.parts = parts;
    options.super_skeleton = std::make_shared<const skin::SuperSkeleton>(skin::learn_super_skeleton(skeletons));
  }
  std::vector<const Example*> all() const { return {&examples[0], &examples[1]}; }
};

TEST(NeuroBatch, each_vertex_s_targets_sum_to_one_or_are_zero) {
  const Corpus corpus(Parts::neuro);
  Random random(1);
  const auto biped = varied(corpus.examples[0], Parts::neuro, {}, random), quadruped = varied(corpus.examples[1], Parts::neuro, {}, random);
  const Example* changed[] = {biped.get(), quadruped.get()};
  const Batch batch = training_batch(changed, corpus.options, {}, random);
  const nets::BindArrays& choices = batch.inputs.neuro.choices;
  ASSERT_EQ(choices.offsets.size(), static_cast<std::size_t>(batch.inputs.mesh.batch.rows()) + 1);
  ASSERT_EQ(batch.targets.skin.size(), choices.vertex_of.size());
  ASSERT_EQ(batch.targets.log_shares.size(), choices.vertex_of.size());
  for (std::size_t v = 0; v + 1 < choices.offsets.size(); ++v) {
    const auto row =
        std::span(batch.targets.skin)
            .subspan(static_cast<std::size_t>(choices.offsets[v]), static_cast<std::size_t>(choices.offsets[v + 1] - choices.offsets[v]));
    EXPECT_NEAR(std::accumulate(row.begin(), row.end(), 0.0f), batch.targets.skin_share[v] > 0.0f ? 1.0f : 0.0f, 1e-4f);
  }
  const std::size_t joints = choices.bone_offsets.size() - 1;
  EXPECT_EQ(batch.inputs.neuro.joints.size(), joints * (nets::neuro_joint_features + nets::neuro_kinds));
}

TEST(NeuroBatch, pools_the_vertex_itself_and_at_most_so_many_of_the_same_mesh) {
  const Corpus corpus(Parts::neuro);
  const Batch batch = plain_batch(corpus.all(), corpus.options);
  const auto& mesh_of = batch.inputs.mesh.batch.mesh_of;
  for (std::size_t level = 0; level < nets::neuro_pooling.size(); ++level) {
    const nets::EdgeArrays& near = batch.inputs.neuro.nearest[level];
    ASSERT_EQ(near.offsets.size(), mesh_of.size() + 1);
    for (std::size_t v = 0; v < mesh_of.size(); ++v) {
      EXPECT_EQ(near.sources[static_cast<std::size_t>(near.offsets[v])], static_cast<std::int32_t>(v));
      EXPECT_LE(near.offsets[v + 1] - near.offsets[v], static_cast<std::int32_t>(nets::neuro_pooling[level]));
      for (std::int32_t e = near.offsets[v]; e < near.offsets[v + 1]; ++e)
        ASSERT_EQ(mesh_of[static_cast<std::size_t>(near.sources[static_cast<std::size_t>(e)])], mesh_of[v]);
    }
  }
}

TEST(NeuroBatch, the_paper_s_targets_lie_on_slots_that_the_skeleton_has) {
  const Corpus corpus(Parts::neuro_2019);
  const Batch batch = plain_batch(corpus.all(), corpus.options);
  const auto vertices = static_cast<std::size_t>(batch.inputs.mesh.batch.rows());
  ASSERT_EQ(batch.targets.skin.size(), vertices * nets::neuro_slots);
  ASSERT_EQ(batch.inputs.neuro.features.size(), vertices * (nets::neuro_vertex_features + nets::neuro_slots));
  for (std::size_t v = 0; v < vertices; ++v) {
    float sum = 0.0f;
    for (std::size_t s = v * nets::neuro_slots; s < (v + 1) * nets::neuro_slots; ++s) {
      sum += batch.targets.skin[s];
      if (batch.targets.slots[s] != 0.0f) EXPECT_EQ(batch.targets.skin[s], 0.0f);
    }
    EXPECT_NEAR(sum, 1.0f, 1e-4f);
  }
}

}  // namespace
}  // namespace osteon::dataset
