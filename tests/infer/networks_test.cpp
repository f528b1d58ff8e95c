// SPDX-License-Identifier: Apache-2.0
#include "osteon/infer/networks.h"

#include "examples.h"
#include "osteon/infer/loops_backend.h"
#include "osteon/infer/onednn_backend.h"
#include "support/expect.h"

namespace osteon::infer {
namespace {

using test::ExampleInput;
using test::Network;
using test::random_parameters;
using test::ScopedThreads;

class Networks : public testing::TestWithParam<Network> {};

INSTANTIATE_TEST_SUITE_P(rignet, Networks, testing::ValuesIn(nets::rignet::kNetworks), test::name_of);

TEST_P(Networks, onednn_equals_the_plain_loops) {
  const ExampleInput input = test::one_mesh(90, 6, 5);
  Loops loops(random_parameters(GetParam(), 3));
  Onednn onednn(random_parameters(GetParam(), 3));
  EXPECT_LE(test::relative_difference(run(GetParam(), onednn, input.view()), run(GetParam(), loops, input.view())), 1e-5f);
}

TEST_P(Networks, every_mesh_of_a_batch_gives_what_it_gives_alone) {
  Random random(6);
  ExampleInput both;
  both.add_mesh(90, 4, random);
  both.add_mesh(71, 3, random);
  random = Random(6);
  ExampleInput first;
  first.add_mesh(90, 4, random);
  Onednn onednn(random_parameters(GetParam(), 4));
  const Matrix alone = run(GetParam(), onednn, first.view());
  EXPECT_TRUE(test::same_bits(run(GetParam(), onednn, both.view()).topRows(alone.rows()), alone));
}

TEST_P(Networks, the_same_bits_for_any_number_of_threads) {
  const ExampleInput input = test::one_mesh(400, 12, 7);
  Onednn onednn(random_parameters(GetParam(), 5));
  const Matrix one = [&] {
    const ScopedThreads scope(1);
    return run(GetParam(), onednn, input.view());
  }();
  for (int n : {2, 4}) {
    const ScopedThreads scope(n);
    EXPECT_TRUE(test::same_bits(run(GetParam(), onednn, input.view()), one)) << n;
  }
}

// The input with vertex v become vertex place[v].
ExampleInput renumbered(const ExampleInput& input, const std::vector<std::uint32_t>& place) {
  ExampleInput out = input;
  std::vector<float> features(input.votes.features.size());
  std::vector<std::uint32_t> seeds, region_of(place.size());
  std::vector<std::size_t> vertex_at(place.size());
  for (std::size_t v = 0; v < place.size(); ++v) vertex_at[place[v]] = v;
  for (std::size_t v = 0; v < place.size(); ++v) {
    std::copy_n(input.mesh.positions.begin() + static_cast<std::ptrdiff_t>(3 * v), 3, out.mesh.positions.begin() + 3 * place[v]);
    std::copy_n(input.skin_features.begin() + static_cast<std::ptrdiff_t>(43 * v), 43, out.skin_features.begin() + 43 * place[v]);
    std::copy_n(input.votes.features.begin() + static_cast<std::ptrdiff_t>(nets::vote_features * v), nets::vote_features,
                features.begin() + nets::vote_features * place[v]);
    region_of[place[v]] = static_cast<std::uint32_t>(input.votes.region_of[v]);
  }
  out.votes = {};
  for (const std::int32_t seed : input.votes.seeds) seeds.push_back(place[static_cast<std::size_t>(seed)]);
  out.votes.add(features, seeds, region_of, 0);
  auto edges = [&](const nets::EdgeArrays& before) {
    std::vector<std::uint32_t> offsets{0}, members;
    for (const std::size_t v : vertex_at) {
      for (auto e = static_cast<std::size_t>(before.offsets[v]) + 1; e < static_cast<std::size_t>(before.offsets[v + 1]); ++e)
        members.push_back(place[static_cast<std::size_t>(before.sources[e])]);  // the first is the self loop
      offsets.push_back(static_cast<std::uint32_t>(members.size()));
    }
    nets::EdgeArrays after;
    after.add(offsets, members, 0);
    return after;
  };
  out.mesh.ring = edges(input.mesh.ring);
  out.mesh.geodesic = edges(input.mesh.geodesic);
  auto choices = [&](const nets::BindArrays& before, int width) {
    std::vector<float> of_choices;
    std::vector<std::int32_t> offsets{0}, bones;
    for (const std::size_t v : vertex_at) {
      const std::int32_t first = before.offsets[v], last = before.offsets[v + 1];
      const float* rows = before.features.data();
      of_choices.insert(of_choices.end(), rows + first * width, rows + last * width);
      bones.insert(bones.end(), before.bone_of.begin() + first, before.bone_of.begin() + last);
      offsets.push_back(offsets.back() + last - first);
    }
    nets::BindArrays after;
    after.add(of_choices, offsets, bones);
    return after;
  };
  out.choices = choices(input.choices, nets::bind_features);
  out.neuro.choices = choices(input.neuro.choices, nets::neuro_choice_features);
  constexpr std::size_t width = nets::neuro_vertex_features + nets::neuro_slots;
  for (std::size_t v = 0; v < place.size(); ++v)
    std::copy_n(input.neuro.features.begin() + static_cast<std::ptrdiff_t>(width * v), width,
                out.neuro.features.begin() + static_cast<std::ptrdiff_t>(width * place[v]));
  for (std::size_t level = 0; level < out.neuro.nearest.size(); ++level) out.neuro.nearest[level] = edges(input.neuro.nearest[level]);
  return out;
}

// Where the rows of a network's output go when the vertices are renumbered.
std::vector<std::int32_t> places_of_rows(Network network, const ExampleInput& before, const ExampleInput& after,
                                         const std::vector<std::uint32_t>& place, Eigen::Index rows) {
  std::vector<std::int32_t> out(static_cast<std::size_t>(rows));
  std::iota(out.begin(), out.end(), 0);  // pairs and joints stay
  const auto by_choices = [&](const nets::BindArrays& old_rows, const nets::BindArrays& new_rows) {
    for (std::size_t r = 0; r < out.size(); ++r) {
      const auto v = static_cast<std::size_t>(old_rows.vertex_of[r]);
      out[r] = new_rows.offsets[place[v]] + static_cast<std::int32_t>(r) - old_rows.offsets[v];
    }
  };
  if (network == Network::bind)
    by_choices(before.choices, after.choices);
  else if (network == Network::neuroskinning)
    by_choices(before.neuro.choices, after.neuro.choices);
  else if (out.size() == place.size())
    out.assign(place.begin(), place.end());
  return out;
}

TEST_P(Networks, renumbering_the_vertices_renumbers_the_output_and_nothing_else) {
  const ExampleInput input = test::one_mesh(200, 5, 8);
  std::vector<std::uint32_t> place(200);
  std::iota(place.begin(), place.end(), 0u);
  Random random(9);
  random.shuffle<std::uint32_t>(place);
  Onednn onednn(random_parameters(GetParam(), 6));
  const Matrix before = run(GetParam(), onednn, input.view());
  const ExampleInput other = renumbered(input, place);
  const Matrix after = run(GetParam(), onednn, other.view());
  ASSERT_EQ(before.rows(), after.rows());
  const auto places = places_of_rows(GetParam(), input, other, place, before.rows());
  for (Eigen::Index r = 0; r < before.rows(); ++r)
    EXPECT_TRUE(test::same_bits(after.row(places[static_cast<std::size_t>(r)]), before.row(r))) << r;
}

}  // namespace
}  // namespace osteon::infer
