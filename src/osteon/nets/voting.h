// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/nets/rignet.h"

// Where the joints are, as the vertices see it. Ours, in place of RigNet's JointNet and MaskNet (nets/rignet.h): one body for displacement
// and attention; a vertex starts from the middle of the body beneath it (geometry/vote_features.h) instead of having to find it out; more
// and narrower graph convolutions.
// It is told the level of detail: how many joints the rig shall have (the same number for all vertices). Artists who give a body six joints
// and artists who give it sixty put them elsewhere; without that number the network has to guess whom it learns from.
// A tenth of the parameters of the paper's two networks, which a CPU can train. What it gains is in docs/results.md.
namespace osteon::nets {

constexpr int vote_features = 26;  // of a vertex: see geometry/vote_features.h
constexpr int vote_to_middle = 3;  // the column where the way to the middle of the body begins

// (V,4): columns 0 to 2 from the middle of the body beneath the vertex (vertex + features 3 to 5) towards a joint near it, in the unit of
// the positions; column 3 the logit of the attention.
template <Ops B>
typename B::Tensor vote_net(B& b, const MeshGraph<B>& mesh, const typename B::Tensor& features) {
  const auto x0 = mlp<B>(b, Path("input"), {mesh.positions, features}, {32});
  const auto x1 = rignet::gcu(b, Path("gcu1"), x0, mesh, 64);
  const auto x2 = rignet::gcu(b, Path("gcu2"), x1, mesh, 128);
  const auto x3 = rignet::gcu(b, Path("gcu3"), x2, mesh, 128);
  const auto x4 = rignet::gcu(b, Path("gcu4"), x3, mesh, 128);
  const auto pooled = mlp<B>(b, Path("global"), {x1, x2, x3, x4}, {256});
  const auto global = b.max_by(pooled, mesh.batch.offsets);
  const auto head = mlp<B>(b, Path("head"), {{global, mesh.batch.mesh_of}, mesh.positions, features, x1, x2, x3, x4}, {512, 256});
  return b.linear(Path("out"), head, 4);
}

}  // namespace osteon::nets
