// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>

#include <numeric>
#include <string>
#include <vector>

#include "osteon/base/random.h"
#include "osteon/infer/networks.h"
#include "osteon/infer/parameters.h"
#include "osteon/nets/rignet.h"
#include "support/numbers.h"

// Seeded weights and inputs for the networks.
namespace osteon::test {

using nets::rignet::Network;

inline std::string name_of(const testing::TestParamInfo<Network>& network) { return nets::rignet::name_of(network.param); }

// Weights of about the size that training starts from; normalisations of both signs, means and variances that are not 0 and 1.
inline Safetensors random_weights(const infer::Shapes& shapes, std::uint64_t seed) {
  Random random(seed);
  Safetensors out;
  for (const auto& [name, shape] : shapes) {
    const auto count = static_cast<std::size_t>(std::accumulate(shape.begin(), shape.end(), std::int64_t{1}, std::multiplies<>()));
    const float deviation = shape.size() == 2 ? std::sqrt(2.0f / static_cast<float>(shape[1])) : 0.3f;
    std::vector<float> values = random_floats(count, random, deviation);
    if (name.ends_with("running_var"))
      for (float& v : values) v = 0.5f + std::abs(v);
    if (name.ends_with("norm.weight"))
      for (float& v : values) v = (random.below(3) == 0 ? -1.0f : 1.0f) * random.uniform(0.5f, 1.5f);
    out.arrays.emplace(name, Array::of<float>(values, shape));
  }
  return out;
}

inline infer::Parameters random_parameters(Network network, std::uint64_t seed) {
  const infer::Shapes shapes = nets::rignet::parameter_shapes(network);
  return {random_weights(shapes, seed), shapes, "seeded"};
}

// Vertices in the unit box with 3 to 8 one-ring and 0 to 12 geodesic neighbours each, joints, all pairs of them, skin features.
struct ExampleInput : nets::NetworkInputs {
  infer::NetworkInput view() const { return {mesh, &joints, &pairs, skin_features, &choices, &votes, &tree, &neuro}; }

  void add_mesh(std::size_t vertices, std::size_t joint_count, Random& random) {
    const std::int32_t first_vertex = mesh.batch.rows(), first_joint = joints.batch.rows();
    const auto mesh_id = static_cast<std::int32_t>(mesh.batch.offsets.size()) - 1;
    append(mesh.positions, 3 * vertices, random);
    append(skin_features, nets::rignet::skin_inputs * vertices, random);
    add_votes(vertices, first_vertex, random);
    add_neighbours(mesh.ring, vertices, 3, 8, first_vertex, random);
    add_neighbours(mesh.geodesic, vertices, 0, 12, first_vertex, random);
    mesh.batch.add(vertices);
    add_choices(choices, nets::bind_features, vertices, random);
    add_neuro(vertices, first_vertex, random);
    append(joints.positions, 3 * joint_count, random);
    append(joints.plane_distance, joint_count, random);
    joints.pairs.add_complete(static_cast<std::int32_t>(joint_count), first_joint);
    joints.batch.add(joint_count);
    add_tree(joint_count, random);
    for (std::int32_t i = first_joint; i < joints.batch.rows(); ++i) {
      for (std::int32_t j = i + 1; j < joints.batch.rows(); ++j) {
        pairs.first.push_back(i);
        pairs.second.push_back(j);
        pairs.mesh_of.push_back(mesh_id);
        append(pairs.features, 8, random);
      }
    }
  }

  void add_votes(std::size_t vertices, std::int32_t first_vertex, Random& random) {
    std::vector<float> features;
    append(features, nets::vote_features * vertices, random);
    std::vector<std::uint32_t> seeds, region_of;
    for (std::uint32_t v = 0; v < vertices; ++v) {
      const bool seed = v % 5 == 0 && seeds.size() < nets::vote_regions;
      region_of.push_back(static_cast<std::uint32_t>(seed ? seeds.size() : random.below(seeds.size())));
      if (seed) seeds.push_back(v);
    }
    votes.add(features, seeds, region_of, first_vertex);
  }

  void add_tree(std::size_t joint_count, Random& random) {
    std::vector<float> of_joints, of_pairs;
    append(of_joints, nets::tree_joint_features * joint_count, random);
    append(of_pairs, nets::tree_pair_features * joint_count * joint_count, random);
    tree.add(of_joints, of_pairs);
  }

 private:
  static void append(std::vector<float>& to, std::size_t count, Random& random) {
    for (std::size_t i = 0; i < count; ++i) to.push_back(random.uniform());
  }
  void add_neuro(std::size_t vertices, std::int32_t first_vertex, Random& random) {
    append(neuro.features, (nets::neuro_vertex_features + nets::neuro_slots) * vertices, random);
    const std::size_t before = neuro.choices.bone_offsets.size();
    add_choices(neuro.choices, nets::neuro_choice_features, vertices, random);
    append(neuro.joints, (nets::neuro_joint_features + nets::neuro_kinds) * (neuro.choices.bone_offsets.size() - before), random);
    for (nets::EdgeArrays& nearest : neuro.nearest) add_neighbours(nearest, vertices, 0, 12, first_vertex, random);
  }
  // 1 to 8 bones for each vertex
  static void add_choices(nets::BindArrays& choices, int width, std::size_t vertices, Random& random) {
    std::vector<std::int32_t> offsets{0};
    for (std::size_t v = 0; v < vertices; ++v) offsets.push_back(offsets.back() + 1 + static_cast<std::int32_t>(random.below(8)));
    std::vector<float> features;
    append(features, static_cast<std::size_t>(offsets.back() * width), random);
    std::vector<std::int32_t> bones;
    for (std::int32_t i = 0; i < offsets.back(); ++i) bones.push_back(static_cast<std::int32_t>(random.below(9)));
    choices.add(features, offsets, bones);
  }
  static void add_neighbours(nets::EdgeArrays& edges, std::size_t vertices, std::size_t least, std::size_t most, std::int32_t first,
                             Random& random) {
    std::vector<std::uint32_t> offsets{0}, members;
    for (std::size_t v = 0; v < vertices; ++v) {
      for (std::size_t k = least + random.below(most - least + 1); k > 0; --k)
        members.push_back(static_cast<std::uint32_t>(random.below(vertices)));
      offsets.push_back(static_cast<std::uint32_t>(members.size()));
    }
    edges.add(offsets, members, first);
  }
};

inline ExampleInput one_mesh(std::size_t vertices, std::size_t joints, std::uint64_t seed) {
  Random random(seed);
  ExampleInput out;
  out.add_mesh(vertices, joints, random);
  return out;
}

}  // namespace osteon::test
