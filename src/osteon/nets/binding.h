// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/nets/rignet.h"

// Which of the bones near it each vertex follows. Ours, in place of RigNet's SkinNet (nets/rignet.h): every bone of a vertex is judged by
// the same small network from how it lies to the vertex (geometry/bind_features.h), not by its slot and absolute coordinates. It has a
// thirtieth of SkinNet's parameters, does not care where a limb is or how many bones there are, and learns more from few characters
// (docs/results.md).
namespace osteon::nets {

// Logits for a softmax over the bones of each vertex, (C,1).
template <Ops B>
typename B::Tensor bind_net(B& b, const MeshGraph<B>& mesh, const BindChoices<B>& choices) {
  const auto bone = mlp<B>(b, Path("bone"), {choices.features}, {64, 64});
  const auto vertex = b.max_by(bone, choices.offsets);  // what a vertex sees of all its bones
  const auto x1 = rignet::gcu(b, Path("gcu1"), vertex, mesh, 64);
  const auto x2 = rignet::gcu(b, Path("gcu2"), x1, mesh, 64);
  const auto head = mlp<B>(
      b, Path("head"), {bone, {vertex, choices.vertex_of}, {x1, choices.vertex_of}, {x2, choices.vertex_of}, choices.features}, {128, 64});
  return b.linear(Path("out"), head, 1);
}

}  // namespace osteon::nets
