// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <numbers>
#include <vector>

#include "osteon/base/random.h"
#include "osteon/train/networks.h"

// Inputs of the networks without meshes: rings of vertices with neighbours beside them, and joints on a line.
namespace osteon::train::test {

// Of the norms, as a share.
inline float difference(const at::Tensor& a, const at::Tensor& b) { return ((a - b).norm() / (b.norm() + 1e-6f)).item<float>(); }

// What the voting and the binding network read.
inline void add_features(NetworkInputs& inputs, int vertices, Random random) {
  std::vector<float> of_votes;
  for (int i = 0; i < vertices * nets::vote_features; ++i) of_votes.push_back(random.uniform(-1.0f, 1.0f));
  const std::vector<std::uint32_t> seeds{0, 2, 1};
  std::vector<std::uint32_t> region_of;
  for (int v = 0; v < vertices; ++v) region_of.push_back(v < 3 ? std::array{0u, 2u, 1u}[v] : static_cast<std::uint32_t>(random.below(3)));
  inputs.votes.add(of_votes, seeds, region_of, static_cast<std::int32_t>(inputs.votes.region_of.size()));
  std::vector<std::int32_t> choice_offsets{0};
  for (int v = 0; v < vertices; ++v) choice_offsets.push_back(choice_offsets.back() + 1 + v % 4);
  std::vector<float> features;
  std::vector<std::int32_t> bones;
  for (int i = 0; i < choice_offsets.back() * nets::bind_features; ++i) features.push_back(random.uniform(-1.0f, 1.0f));
  for (int i = 0; i < choice_offsets.back(); ++i) bones.push_back(static_cast<std::int32_t>(random.below(7)));
  inputs.choices.add(features, choice_offsets, bones);
}

// What the NeuroSkinning networks read; the nearest vertices are those of the geodesic neighbours.
inline void add_neuro(NetworkInputs& inputs, int vertices, Random random) {
  nets::NeuroArrays& neuro = inputs.neuro;
  const auto add = [&](std::vector<float>& to, int count) {
    for (int i = 0; i < count; ++i) to.push_back(random.uniform(-1.0f, 1.0f));
  };
  add(neuro.features, vertices * (nets::neuro_vertex_features + nets::neuro_slots));
  std::vector<std::int32_t> offsets{0}, joints;
  for (int v = 0; v < vertices; ++v) offsets.push_back(offsets.back() + 1 + v % 4);
  for (int i = 0; i < offsets.back(); ++i) joints.push_back(static_cast<std::int32_t>(random.below(7)));
  std::vector<float> features;
  add(features, offsets.back() * nets::neuro_choice_features);
  const std::size_t before = neuro.choices.bone_offsets.size();
  neuro.choices.add(features, offsets, joints);
  add(neuro.joints, static_cast<int>(neuro.choices.bone_offsets.size() - before) * (nets::neuro_joint_features + nets::neuro_kinds));
}

// `vertices` points near a circle; neighbours at one and two steps (one-ring) and at three and five (geodesic).
inline void add_ring_mesh(NetworkInputs& inputs, int vertices, Random& random) {
  std::vector<std::uint32_t> offsets{0}, ring, geodesic;
  const std::int32_t first = inputs.mesh.batch.rows();
  for (int v = 0; v < vertices; ++v) {
    const float angle = 2.0f * std::numbers::pi_v<float> * static_cast<float>(v) / static_cast<float>(vertices);
    inputs.mesh.positions.insert(inputs.mesh.positions.end(), {0.4f * std::cos(angle) + random.uniform(-0.05f, 0.05f),
                                                               0.5f + 0.4f * std::sin(angle), random.uniform(-0.1f, 0.1f)});
    const auto at = [&](int step) { return static_cast<std::uint32_t>((v + step + vertices) % vertices); };
    ring.insert(ring.end(), {at(1), at(-1), at(2), at(-2)});
    geodesic.insert(geodesic.end(), {at(3), at(-3), at(5), at(-5)});
    offsets.push_back(static_cast<std::uint32_t>(ring.size()));
  }
  inputs.mesh.ring.add(offsets, ring, first);
  inputs.mesh.geodesic.add(offsets, geodesic, first);
  inputs.mesh.batch.add(static_cast<std::size_t>(vertices));
  for (int i = 0; i < vertices * nets::rignet::skin_inputs; ++i) inputs.skin_features.push_back(random.uniform(-1.0f, 1.0f));
  add_features(inputs, vertices, Random(static_cast<std::uint64_t>(vertices)));
  add_neuro(inputs, vertices, Random(static_cast<std::uint64_t>(vertices) + 1));
  for (nets::EdgeArrays& nearest : inputs.neuro.nearest) nearest.add(offsets, geodesic, first);
}

inline void add_joints(NetworkInputs& inputs, int joints, Random& random) {
  const std::int32_t first = inputs.joints.batch.rows();
  const std::int32_t mesh = static_cast<std::int32_t>(inputs.joints.batch.offsets.size()) - 1;
  for (int j = 0; j < joints; ++j) {
    inputs.joints.positions.insert(inputs.joints.positions.end(), {random.uniform(-0.3f, 0.3f), 0.1f * static_cast<float>(j), 0.0f});
    inputs.joints.plane_distance.push_back(random.uniform(0.0f, 0.3f));
    for (int i = 0; i < j; ++i) {
      inputs.pairs.first.push_back(first + i);
      inputs.pairs.second.push_back(first + j);
      inputs.pairs.mesh_of.push_back(mesh);
      for (int k = 0; k < 8; ++k) inputs.pairs.features.push_back(random.uniform(-0.5f, 0.5f));
    }
  }
  inputs.joints.pairs.add_complete(joints, first);
  inputs.joints.batch.add(static_cast<std::size_t>(joints));
  std::vector<float> of_joints, of_pairs;
  for (int i = 0; i < joints * nets::tree_joint_features; ++i) of_joints.push_back(random.uniform(-1.0f, 1.0f));
  for (int i = 0; i < joints * joints * nets::tree_pair_features; ++i) of_pairs.push_back(random.uniform(-1.0f, 1.0f));
  inputs.tree.add(of_joints, of_pairs);
}

inline NetworkInputs two_characters(int vertices = 40, int joints = 6) {
  Random random(11);
  NetworkInputs inputs;
  for (const int extra : {0, 7}) {
    add_ring_mesh(inputs, vertices + extra, random);
    add_joints(inputs, joints + extra / 3, random);
  }
  return inputs;
}

}  // namespace osteon::train::test
