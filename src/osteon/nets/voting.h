// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/nets/rignet.h"

// Where the joints are, as the vertices see it. Ours, in place of RigNet's JointNet and MaskNet (nets/rignet.h): one body for displacement
// and attention; a vertex starts from the middle of the body beneath it (geometry/vote_features.h) instead of having to find it out; more
// and narrower graph convolutions.
// Between the second and the third, the surface is cut into 64 regions (geometry/regions.h), and each compares itself with all others in
// three edge convolutions: where a knee is depends on where hip and foot are, farther away than four neighbourhoods of a vertex reach.
// It is told the level of detail: how many joints the rig shall have (the same number for all vertices). Artists who give a body six joints
// and artists who give it sixty put them elsewhere; without that number the network has to guess whom it learns from.
// What it gains is in docs/results.md.
namespace osteon::nets {

constexpr int vote_to_middle = 3;  // the column of the features where the way to the middle of the body begins

// Displacements come out in this unit: about as long as they are. An optimiser that moves every weight of the last layer by the learning
// rate, as Adam does, moves 256 inputs' sum by a hundred times as much; in the unit of the positions the votes would jump about by more
// than they have to learn.
constexpr float vote_unit = 0.05f;

// What each region (R,128) is among all regions of its mesh, from what its vertices are. Positions are shown again at every step, as the
// convolutions compare by differences.
template <Ops B>
typename B::Tensor regions_in_context(B& b, const MeshGraph<B>& mesh, const Votes<B>& votes, const typename B::Tensor& of_vertex) {
  const auto centres = b.rows(mesh.positions, votes.seeds);
  const auto sorted = b.rows(of_vertex, votes.members);
  auto x = b.max_by(sorted, votes.offsets);
  for (const char* step : {"region1", "region2", "region3"}) {
    const auto placed = b.concat({centres, x});
    x = edge_conv(b, Path(step), placed, votes.pairs, 128);
  }
  return x;
}

// (V,4): columns 0 to 2 from the middle of the body beneath the vertex (vertex + features 3 to 5) towards a joint near it, in vote_unit of
// the positions' unit; column 3 the logit of the attention.
template <Ops B>
typename B::Tensor vote_net(B& b, const MeshGraph<B>& mesh, const Votes<B>& votes) {
  const auto& features = votes.features;
  const auto x0 = mlp<B>(b, Path("input"), {mesh.positions, features}, {32});
  const auto x1 = rignet::gcu(b, Path("gcu1"), x0, mesh, 64);
  const auto x2 = rignet::gcu(b, Path("gcu2"), x1, mesh, 128);
  const auto of_vertex = mlp<B>(b, Path("region0"), {x0, x1, x2}, {128});
  const auto regions = regions_in_context(b, mesh, votes, of_vertex);
  const auto informed = mlp<B>(b, Path("informed"), {mesh.positions, features, x2, {regions, votes.region_of}}, {128});
  const auto near_and_far = b.concat({x2, informed});
  const auto x3 = rignet::gcu(b, Path("gcu3"), near_and_far, mesh, 128);
  const auto x4 = rignet::gcu(b, Path("gcu4"), x3, mesh, 128);
  const auto pooled = mlp<B>(b, Path("global"), {x1, x2, x3, x4}, {256});
  const auto global = b.max_by(pooled, mesh.batch.offsets);
  const auto head =
      mlp<B>(b, Path("head"),
             {{global, mesh.batch.mesh_of}, {regions, votes.region_of}, mesh.positions, features, informed, x1, x2, x3, x4}, {512, 256});
  return b.linear(Path("out"), head, 4);
}

}  // namespace osteon::nets
