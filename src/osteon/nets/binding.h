// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/nets/rignet.h"

// Which of the bones near it each vertex follows. Ours, in place of RigNet's SkinNet (nets/rignet.h): every bone of a vertex is judged by
// the same small network from how it lies to the vertex (geometry/bind_features.h), not by its slot and absolute coordinates. It has a
// fraction of SkinNet's parameters, does not care where a limb is or how many bones there are, and learns more from few characters
// (docs/results.md).
namespace osteon::nets {

// Logits for a softmax over the bones of each vertex, (C,1).
template <Ops B>
typename B::Tensor bind_net(B& b, const MeshGraph<B>& mesh, const BindChoices<B>& choices) {
  const auto pair = mlp<B>(b, Path("pair"), {choices.features}, {128, 64});
  const auto vertex = b.max_by(pair, choices.offsets);  // what a vertex sees of its bones
  const auto sorted = b.rows(pair, choices.by_bone);
  const auto bone = b.max_by(sorted, choices.bone_offsets);  // what a bone sees of its vertices
  const auto x1 = rignet::gcu(b, Path("gcu1"), vertex, mesh, 128);
  const auto x2 = rignet::gcu(b, Path("gcu2"), x1, mesh, 128);
  const auto of_vertex = mlp<B>(b, Path("vertex"), {vertex, x1, x2}, {128});
  const auto head = mlp<B>(b, Path("head"), {pair, choices.features, {bone, choices.bone_of}, {of_vertex, choices.vertex_of}}, {128, 128});
  return b.linear(Path("out"), head, 1);
}

}  // namespace osteon::nets
