// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "osteon/nets/layers.h"

// The inputs of the graph networks: several meshes (or skeletons) laid one after the other, first as arrays, then on a backend.
namespace osteon::nets {

struct EdgeArrays {
  std::vector<std::int32_t> offsets{0}, sources, receivers;  // see Edges

  // The edges of the next mesh, whose first vertex is `first`: neighbours of its v-th vertex are members[offsets[v] .. offsets[v+1]-1],
  // itself not among them (a self loop is added), numbered from 0 within the mesh.
  void add(std::span<const std::uint32_t> mesh_offsets, std::span<const std::uint32_t> members, std::int32_t first) {
    for (std::size_t v = 0; v + 1 < mesh_offsets.size(); ++v) {
      const auto receiver = first + static_cast<std::int32_t>(v);
      sources.push_back(receiver);
      for (std::uint32_t k = mesh_offsets[v]; k < mesh_offsets[v + 1]; ++k)
        sources.push_back(first + static_cast<std::int32_t>(members[k]));
      receivers.resize(sources.size(), receiver);
      offsets.push_back(static_cast<std::int32_t>(sources.size()));
    }
  }

  // From each of `count` rows to each of them, itself included.
  void add_complete(std::int32_t count, std::int32_t first) {
    for (std::int32_t v = 0; v < count; ++v) {
      for (std::int32_t u = 0; u < count; ++u) sources.push_back(first + u);
      receivers.resize(sources.size(), first + v);
      offsets.push_back(static_cast<std::int32_t>(sources.size()));
    }
  }
};

// Which rows belong to which mesh of the batch.
struct BatchArrays {
  std::vector<std::int32_t> offsets{0};  // (M+1)
  std::vector<std::int32_t> mesh_of;     // (N)

  std::int32_t rows() const { return offsets.back(); }
  void add(std::size_t count) {
    assert(count > 0);
    mesh_of.resize(mesh_of.size() + count, static_cast<std::int32_t>(offsets.size()) - 1);
    offsets.push_back(static_cast<std::int32_t>(mesh_of.size()));
  }
};

struct MeshArrays {
  std::vector<float> positions;  // (V,3) normalised: longest side 1, feet on y = 0, centred on x and z
  EdgeArrays ring, geodesic;     // one-ring; up to 10 or 15 vertices within geodesic distance 0.06
  BatchArrays batch;
};

struct JointArrays {
  std::vector<float> positions;       // (J,3) in the frame of the mesh
  std::vector<float> plane_distance;  // (J) distance (>= 0) to the mesh's plane of symmetry, or to x = 0 where there is none
  EdgeArrays pairs;                   // all of the same mesh: add_complete
  BatchArrays batch;
};

// Pairs of joints of the same mesh, in the order (first, second) that the features describe.
struct PairArrays {
  std::vector<std::int32_t> first, second;  // (P) rows of the joints
  std::vector<float> features;              // (P,8) first's position, second's position, distance, share of it inside the shape
  std::vector<std::int32_t> mesh_of;        // (P)
};

// The bones that each vertex may follow: a row for each vertex and bone (geometry/bind_features.h).
struct BindArrays {
  std::vector<float> features;                // (C,bind_features)
  std::vector<std::int32_t> offsets{0};       // (V+1) rows of vertex v are offsets[v] .. offsets[v+1]-1
  std::vector<std::int32_t> vertex_of;        // (C)
  std::vector<std::int32_t> by_bone;          // (C) the rows again, in the order of their bones
  std::vector<std::int32_t> bone_offsets{0};  // (B+1) those of bone b are by_bone[bone_offsets[b] .. bone_offsets[b+1]-1]; none is without
  std::vector<std::int32_t> bone_of;          // (C) which of the B

  // The rows of the next mesh's vertices, numbered from 0 within it, and which of its bones each is about.
  void add(std::span<const float> mesh_features, std::span<const std::int32_t> mesh_offsets, std::span<const std::int32_t> mesh_bones) {
    features.insert(features.end(), mesh_features.begin(), mesh_features.end());
    const std::int32_t first = offsets.back();
    by_bone.resize(by_bone.size() + mesh_bones.size());
    const std::span own = std::span(by_bone).last(mesh_bones.size());
    std::iota(own.begin(), own.end(), first);
    const auto bone = [&](std::int32_t row) { return mesh_bones[static_cast<std::size_t>(row - first)]; };
    std::ranges::stable_sort(own, {}, bone);
    bone_of.resize(by_bone.size());
    for (std::size_t i = 0; i < own.size(); ++i) {
      if (i > 0 && bone(own[i]) != bone(own[i - 1])) bone_offsets.push_back(first + static_cast<std::int32_t>(i));
      bone_of[static_cast<std::size_t>(own[i])] = static_cast<std::int32_t>(bone_offsets.size()) - 1;
    }
    if (!own.empty()) bone_offsets.push_back(static_cast<std::int32_t>(by_bone.size()));
    for (std::size_t v = 0; v + 1 < mesh_offsets.size(); ++v) {
      vertex_of.insert(vertex_of.end(), static_cast<std::size_t>(mesh_offsets[v + 1] - mesh_offsets[v]),
                       static_cast<std::int32_t>(offsets.size()) - 1);
      offsets.push_back(first + mesh_offsets[v + 1]);
    }
  }
};
constexpr int bind_features = 21;  // of a vertex and a bone

// What the voting network reads beside the mesh: features of the vertices (geometry/vote_features.h), and the surface cut into regions
// (geometry/regions.h), each of which sees all others of its mesh.
constexpr int vote_features = 26;
constexpr int vote_regions = 64;  // of a mesh, or as many as it has vertices
struct VoteArrays {
  std::vector<float> features;           // (V,vote_features)
  std::vector<std::int32_t> seeds;       // (R) the vertex in the middle of each region
  std::vector<std::int32_t> members;     // (V) vertices in the order of their regions
  std::vector<std::int32_t> offsets{0};  // (R+1) those of region r are members[offsets[r] .. offsets[r+1]-1]; none is without
  std::vector<std::int32_t> region_of;   // (V)
  EdgeArrays pairs;                      // of regions of one mesh: add_complete

  // The next mesh, whose first vertex is `first`; its seeds and regions are numbered from 0 within it.
  void add(std::span<const float> mesh_features, std::span<const std::uint32_t> mesh_seeds, std::span<const std::uint32_t> mesh_region_of,
           std::int32_t first) {
    features.insert(features.end(), mesh_features.begin(), mesh_features.end());
    const auto first_region = static_cast<std::int32_t>(seeds.size());
    for (const std::uint32_t seed : mesh_seeds) seeds.push_back(first + static_cast<std::int32_t>(seed));
    for (const std::uint32_t region : mesh_region_of) region_of.push_back(first_region + static_cast<std::int32_t>(region));
    const std::size_t before = members.size();
    members.resize(region_of.size());
    const std::span own = std::span(members).subspan(before);
    std::iota(own.begin(), own.end(), first);
    std::ranges::stable_sort(own, {}, [&](std::int32_t v) { return region_of[static_cast<std::size_t>(v)]; });
    std::vector<std::int32_t> sizes(mesh_seeds.size(), 0);
    for (const std::uint32_t region : mesh_region_of) ++sizes[region];
    for (const std::int32_t size : sizes) offsets.push_back(offsets.back() + size);
    pairs.add_complete(static_cast<std::int32_t>(mesh_seeds.size()), first_region);
  }
};

// What the tree network reads of the joints of JointArrays and of the pairs of them (geometry/tree_features.h).
constexpr int tree_joint_features = 17, tree_pair_features = 15;
struct TreeArrays {
  std::vector<float> joints;          // (J,tree_joint_features)
  std::vector<float> pairs;           // (P,tree_pair_features) in the order of JointArrays::pairs
  std::vector<std::int32_t> reverse;  // (P) the row of the same pair with source and receiver exchanged

  // Those of the next skeleton.
  void add(std::span<const float> of_joints, std::span<const float> of_pairs) {
    const auto count = static_cast<std::int32_t>(of_joints.size()) / tree_joint_features;
    const auto first = static_cast<std::int32_t>(reverse.size());
    joints.insert(joints.end(), of_joints.begin(), of_joints.end());
    pairs.insert(pairs.end(), of_pairs.begin(), of_pairs.end());
    for (std::int32_t i = 0; i < count; ++i)
      for (std::int32_t j = 0; j < count; ++j) reverse.push_back(first + j * count + i);
  }
};

// What the NeuroSkinning networks read beside the mesh (skin/neuro_features.h).
constexpr int neuro_slots = 256;                                 // of the super skeleton
constexpr int neuro_kinds = 160;                                 // of its joints, left and right alike
constexpr int neuro_vertex_features = 6;                         // position, normal; then a distance for each slot
constexpr int neuro_choice_features = 26;                        // of a vertex and a joint near it
constexpr int neuro_joint_features = 16;                         // of a joint in its skeleton; then one for each kind
constexpr std::array<std::size_t, 3> neuro_pooling{16, 24, 64};  // vertices, the vertex itself among them (the paper's J)
struct NeuroArrays {
  std::vector<float> features;        // (V, neuro_vertex_features + neuro_slots); the paper's network alone
  BindArrays choices;                 // with neuro_choice_features; its "bones" are joints
  std::vector<float> joints;          // (B, neuro_joint_features + neuro_kinds), a row for each of these that some vertex may choose
  std::array<EdgeArrays, 3> nearest;  // the neuro_pooling vertices nearest along the surface

  // Of the next mesh, whose first vertex is `first`: the vertices near each, nearest first, itself not among them.
  void add_nearest(std::span<const std::uint32_t> mesh_offsets, std::span<const std::uint32_t> members, std::int32_t first) {
    for (std::size_t level = 0; level < nearest.size(); ++level) {
      std::vector<std::uint32_t> offsets{0}, kept;
      for (std::size_t v = 0; v + 1 < mesh_offsets.size(); ++v) {
        const auto own = members.subspan(mesh_offsets[v], mesh_offsets[v + 1] - mesh_offsets[v]);
        const auto near = own.first(std::min(own.size(), neuro_pooling[level] - 1));
        kept.insert(kept.end(), near.begin(), near.end());
        offsets.push_back(static_cast<std::uint32_t>(kept.size()));
      }
      nearest[level].add(offsets, kept, first);
    }
  }
};

// The inputs of all networks; what a network does not use may be empty.
struct NetworkInputs {
  MeshArrays mesh;
  JointArrays joints;
  PairArrays pairs;
  std::vector<float> skin_features;  // (V,43)
  VoteArrays votes;
  BindArrays choices;
  TreeArrays tree;
  NeuroArrays neuro;
};

template <class B>
struct Batch {
  typename B::Index offsets;  // (M+1)
  typename B::Index mesh_of;  // (N)
};

template <class B>
struct MeshGraph {
  typename B::Tensor positions;  // (V,3)
  Edges<B> ring, geodesic;
  Batch<B> batch;
};

template <class B>
struct JointSet {
  typename B::Tensor positions;       // (J,3)
  typename B::Tensor plane_distance;  // (J,1)
  Edges<B> pairs;
  Batch<B> batch;
};

template <class B>
struct JointPairs {
  typename B::Index first, second;
  typename B::Tensor features;  // (P,8)
  typename B::Index mesh_of;
};

template <class B>
struct BindChoices {
  typename B::Tensor features;  // (C,bind_features)
  typename B::Index offsets;    // (V+1)
  typename B::Index vertex_of;  // (C)
  typename B::Index by_bone, bone_offsets, bone_of;
};

template <class B>
struct Neuro {
  typename B::Tensor features;
  BindChoices<B> choices;
  typename B::Tensor joints;
  std::array<Edges<B>, 3> nearest;
};

template <class B>
struct Votes {
  typename B::Tensor features;  // (V,vote_features)
  typename B::Index seeds, members, offsets, region_of;
  Edges<B> pairs;
};

template <class B>
struct TreeInputs {
  typename B::Tensor joints, pairs;  // (J,tree_joint_features), (P,tree_pair_features)
  typename B::Index reverse;
};

template <Ops B>
Edges<B> on_backend(B& b, const EdgeArrays& edges) {
  return {b.index(edges.offsets), b.index(edges.sources), b.index(edges.receivers)};
}

template <Ops B>
Batch<B> on_backend(B& b, const BatchArrays& batch) {
  return {b.index(batch.offsets), b.index(batch.mesh_of)};
}

template <Ops B>
MeshGraph<B> on_backend(B& b, const MeshArrays& mesh) {
  return {b.tensor(mesh.positions, mesh.batch.rows(), 3), on_backend(b, mesh.ring), on_backend(b, mesh.geodesic),
          on_backend(b, mesh.batch)};
}

template <Ops B>
JointSet<B> on_backend(B& b, const JointArrays& joints) {
  const int count = joints.batch.rows();
  return {b.tensor(joints.positions, count, 3), b.tensor(joints.plane_distance, count, 1), on_backend(b, joints.pairs),
          on_backend(b, joints.batch)};
}

template <Ops B>
JointPairs<B> on_backend(B& b, const PairArrays& pairs) {
  return {b.index(pairs.first), b.index(pairs.second), b.tensor(pairs.features, static_cast<int>(pairs.first.size()), 8),
          b.index(pairs.mesh_of)};
}

template <Ops B>
BindChoices<B> on_backend(B& b, const BindArrays& choices) {
  return {b.tensor(choices.features, static_cast<int>(choices.vertex_of.size()), bind_features),
          b.index(choices.offsets),
          b.index(choices.vertex_of),
          b.index(choices.by_bone),
          b.index(choices.bone_offsets),
          b.index(choices.bone_of)};
}

// Parts that a network does not read may be empty.
template <Ops B>
Neuro<B> on_backend(B& b, const NeuroArrays& neuro) {
  const auto rows = [](const std::vector<float>& values, int columns) { return static_cast<int>(values.size()) / columns; };
  constexpr int of_vertex = neuro_vertex_features + neuro_slots, of_joint = neuro_joint_features + neuro_kinds;
  const BindArrays& choices = neuro.choices;
  return {b.tensor(neuro.features, rows(neuro.features, of_vertex), of_vertex),
          {b.tensor(choices.features, rows(choices.features, neuro_choice_features), neuro_choice_features), b.index(choices.offsets),
           b.index(choices.vertex_of), b.index(choices.by_bone), b.index(choices.bone_offsets), b.index(choices.bone_of)},
          b.tensor(neuro.joints, rows(neuro.joints, of_joint), of_joint),
          {on_backend(b, neuro.nearest[0]), on_backend(b, neuro.nearest[1]), on_backend(b, neuro.nearest[2])}};
}

template <Ops B>
Votes<B> on_backend(B& b, const VoteArrays& votes) {
  const auto vertices = static_cast<int>(votes.region_of.size());
  return {b.tensor(votes.features, vertices, static_cast<int>(votes.features.size()) / std::max(1, vertices)),
          b.index(votes.seeds),
          b.index(votes.members),
          b.index(votes.offsets),
          b.index(votes.region_of),
          on_backend(b, votes.pairs)};
}

template <Ops B>
TreeInputs<B> on_backend(B& b, const TreeArrays& tree) {
  return {b.tensor(tree.joints, static_cast<int>(tree.joints.size()) / tree_joint_features, tree_joint_features),
          b.tensor(tree.pairs, static_cast<int>(tree.reverse.size()), tree_pair_features), b.index(tree.reverse)};
}

}  // namespace osteon::nets
