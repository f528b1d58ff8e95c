// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/neuroskinning.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "osteon/nets/dry_run.h"
#include "osteon/skin/super_skeleton.h"
#include "osteon/synth/character.h"
#include "osteon/synth/garments.h"
#include "pipelines/biped.h"
#include "pipelines/untrained.h"
#include "skin/heaps.h"
#include "skin/touching.h"
#include "support/expect.h"
#include "support/numbers.h"

namespace osteon::pipelines {
namespace {

using test::LastLayer;
using test::Network;

// A network that was never trained, with a super skeleton of the given slots. With its last layer zero, ours gives the geometric shares.
infer::NeuroskinningModel untrained(Network network, LastLayer last = LastLayer::zero, std::size_t slots = nets::neuro_slots) {
  std::vector<skin::Slot> all;
  for (std::size_t i = 0; i < slots; ++i) all.push_back({{}, {0.0f, static_cast<float>(i) / static_cast<float>(slots), 0.0f}, 0});
  const test::TemporaryFolder folder;
  Safetensors content = test::random_parameters(network, 3, last);
  content.metadata["super_skeleton"] = skin::SuperSkeleton(all).to_json();
  save_safetensors(folder / (std::string(nets::rignet::name_of(network)) + ".safetensors"), content);
  return infer::NeuroskinningModel::load(folder.path());
}

void expect_exact(const SkinWeights& weights, const TriangleMesh& mesh, const Skeleton& skeleton) {
  test::expect_exact(weights, mesh, skeleton);
  EXPECT_LE(weights.max_influences(), 4u);
}

class Neuroskinning : public testing::TestWithParam<Network> {};
INSTANTIATE_TEST_SUITE_P(networks, Neuroskinning, testing::Values(Network::neuroskinning, Network::neuroskinning_2019),
                         [](const auto& network) { return nets::rignet::name_of(network.param); });

TEST_P(Neuroskinning, binds_every_vertex_of_any_heap_of_pieces_to_any_skeleton) {
  const auto model = untrained(GetParam(), LastLayer::random);
  for (std::uint64_t seed = 1; seed <= 25; ++seed) {
    Random random(seed);
    const TriangleMesh mesh = test::heap_of_pieces(random);
    const Skeleton skeleton = test::any_skeleton(random);
    SCOPED_TRACE(seed);
    expect_exact(neuroskinning_weights(mesh, skeleton, model).weights, mesh, skeleton);
  }
}

TEST_P(Neuroskinning, binds_skeletons_of_more_joints_than_slots) {
  const auto model = untrained(GetParam(), LastLayer::random, 20);
  const Rig rig = test::biped();
  Skeleton many = rig.skeleton;
  while (many.size() < 163) {
    const auto parent = static_cast<JointId>(many.size() % rig.skeleton.size());
    many.add("face" + std::to_string(many.size()), parent,
             many.rest_positions[parent] + Vec3f(0.0f, 0.01f, 0.003f * static_cast<float>(many.size() % 7)));
  }
  expect_exact(neuroskinning_weights(rig.mesh, many, model).weights, rig.mesh, many);
}

TEST_P(Neuroskinning, is_the_same_for_any_order_of_vertices_and_any_number_of_threads) {
  const auto model = untrained(GetParam(), LastLayer::random);
  const Rig rig = test::biped();
  const SkinWeights weights = neuroskinning_weights(rig.mesh, rig.skeleton, model).weights;
  {
    const test::ScopedThreads one(1);
    EXPECT_EQ(neuroskinning_weights(rig.mesh, rig.skeleton, model).weights, weights);
  }
  TriangleMesh reversed;
  const auto last = static_cast<std::uint32_t>(rig.mesh.positions.size() - 1);
  for (std::uint32_t v = 0; v <= last; ++v) reversed.positions.push_back(rig.mesh.positions[VertexId{last - v}]);
  for (Triangle t : rig.mesh.faces) {
    for (VertexId& v : t) v = VertexId{last - static_cast<std::uint32_t>(v)};
    reversed.faces.push_back(t);
  }
  const SkinWeights other = neuroskinning_weights(reversed, rig.skeleton, model).weights;
  for (std::uint32_t v = 0; v <= last; ++v) {
    const auto a = weights[VertexId{v}], b = other[VertexId{last - v}];
    ASSERT_TRUE(std::ranges::equal(a, b)) << v;
  }
}

TEST(NeuroskinningOurs, a_network_that_knows_nothing_keeps_touching_parts_apart) {
  const auto model = untrained(Network::neuroskinning);
  const test::Bound two = test::touching_capsules(2);
  const SkinWeights weights = neuroskinning_weights(two.mesh, two.skeleton, model).weights;
  EXPECT_LT(
      test::largest_foreign_weight(weights, {JointId{1}, JointId{2}}, [&](VertexId v) { return index(v) < two.mesh.positions.size() / 2; }),
      0.01f);
}

TEST(NeuroskinningOurs, of_joints_at_one_place_the_one_whose_bone_it_is_gets_the_weights) {
  const auto model = untrained(Network::neuroskinning);
  const Rig rig = test::biped();
  Skeleton stacked = rig.skeleton;
  for (JointId j : rig.skeleton.names.ids()) stacked.add(rig.skeleton.names[j] + "_ctrl", j, rig.skeleton.rest_positions[j]);
  EXPECT_EQ(neuroskinning_weights(rig.mesh, stacked, model).weights, neuroskinning_weights(rig.mesh, rig.skeleton, model).weights);

  // Both capsules hang on joints of their own at one place, as fingers do on a palm.
  test::Bound two = test::touching_capsules(2);
  Skeleton fingers;
  const JointId palm = fingers.add("palm", std::nullopt, {0, -0.5f, 0});
  for (const float x : {-0.1f, 0.1f}) {
    const JointId root = fingers.add(x < 0 ? "first" : "second", palm, {0, -0.2f, 0});
    fingers.add(x < 0 ? "first_tip" : "second_tip", root, {x, 1, 0});
  }
  const SkinWeights weights = neuroskinning_weights(two.mesh, fingers, model).weights;
  double of_first = 0.0, of_second = 0.0;
  for (VertexId v : two.mesh.positions.ids())
    for (const Influence& i : weights[v]) {
      if (i.joint == JointId{1}) of_first += static_cast<double>(i.weight);
      if (i.joint == JointId{3}) of_second += static_cast<double>(i.weight);
    }
  EXPECT_GT(of_first, 10.0);
  EXPECT_NEAR(of_second / of_first, 1.0, 0.3);
}

// Mean over vertices first .. last-1 of the summed differences.
double difference(const SkinWeights& a, const SkinWeights& b, std::size_t first, std::size_t last) {
  double sum = 0.0;
  for (std::size_t i = first; i < last; ++i) {
    std::map<JointId, double> row;
    for (const Influence& w : a[static_cast<VertexId>(i)]) row[w.joint] += static_cast<double>(w.weight);
    for (const Influence& w : b[static_cast<VertexId>(i)]) row[w.joint] -= static_cast<double>(w.weight);
    for (const auto& [joint, d] : row) sum += std::abs(d);
  }
  return sum / static_cast<double>(last - first);
}

// The shipped network on characters of seeds that it was not trained with.
class NeuroskinningShipped : public testing::Test {
 protected:
  static const infer::NeuroskinningModel& model() {
    static const auto loaded = infer::NeuroskinningModel::load();
    return loaded;
  }
};

TEST_F(NeuroskinningShipped, binds_clothes_to_their_own_joints_and_keeps_the_body_off_them) {
  double of_garments = 0.0, of_bodies = 0.0, leak = 0.0;
  constexpr std::uint64_t first = 301, last = 308;
  for (std::uint64_t seed = first; seed <= last; ++seed) {
    const synth::DressedCharacter character =
        synth::dressed(synth::make_character(synth::Kind::Biped, seed, {80, synth::Finish::Smooth}), seed);
    const Rig& rig = character.rig;
    const SkinWeights weights = neuroskinning_weights(rig.mesh, rig.skeleton, model()).weights;
    expect_exact(weights, rig.mesh, rig.skeleton);
    constexpr double share = 1.0 / (last - first + 1);
    of_garments += share * difference(weights, rig.weights, character.body_vertices, rig.mesh.positions.size());
    of_bodies += share * difference(weights, rig.weights, 0, character.body_vertices);
    for (std::size_t v = 0; v < character.body_vertices; ++v)
      for (const Influence& i : weights[static_cast<VertexId>(v)])
        if (index(i.joint) >= character.body_joints)
          leak += share * static_cast<double>(i.weight) / static_cast<double>(character.body_vertices);
  }
  RecordProperty("garments_l1", std::to_string(of_garments));
  RecordProperty("bodies_l1", std::to_string(of_bodies));
  RecordProperty("body_weight_on_garments_joints", std::to_string(leak));
  EXPECT_LT(of_garments, 0.5);
  EXPECT_LT(of_bodies, 0.3);
  EXPECT_LT(leak, 0.02);
}

TEST_F(NeuroskinningShipped, needs_no_names) {
  const Rig rig = synth::make_character(synth::Kind::Biped, 311, {80, synth::Finish::Smooth});
  const SkinWeights named = neuroskinning_weights(rig.mesh, rig.skeleton, model()).weights;
  Skeleton nameless = rig.skeleton;
  for (JointId j : nameless.names.ids()) nameless.names[j] = "Bone." + std::to_string(index(j));
  const SkinWeights unnamed = neuroskinning_weights(rig.mesh, nameless, model()).weights;
  EXPECT_LT(difference(named, rig.weights, 0, rig.mesh.positions.size()), 0.3);
  EXPECT_LT(difference(unnamed, rig.weights, 0, rig.mesh.positions.size()), 0.35);
}

}  // namespace
}  // namespace osteon::pipelines
