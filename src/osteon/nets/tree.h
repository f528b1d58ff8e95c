// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/nets/graph.h"
#include "osteon/nets/layers.h"

// Which joint is the parent of which. Ours, in place of RigNet's BoneNet and RootNet (nets/rignet.h): one small network for both, that
// reads joints and pairs of joints (geometry/tree_features.h), not the mesh. For every joint it says how likely each of the joints is its
// parent; the root is its own. A joint has one parent, so the candidates compete, which independent pairs do not. As in parsing
// sentences: Dozat, Manning. Deep Biaffine Attention for Neural Dependency Parsing. ICLR 2017.
// What it gains is in docs/results.md.
namespace osteon::nets {

// (P,1), a row for each ordered pair of joints of one skeleton in the order of joints.pairs: the logit of the source being the receiver's
// parent, for a softmax over each receiver's rows.
template <Ops B>
typename B::Tensor tree_net(B& b, const JointSet<B>& joints, const TreeInputs<B>& tree) {
  const auto& [offsets, sources, receivers] = joints.pairs;
  auto joint = mlp<B>(b, Path("joint0"), {tree.joints}, {64});
  auto pair = mlp<B>(b, Path("pair0"), {tree.pairs, {joint, receivers}, {joint, sources}}, {64});
  for (const int step : {1, 2, 3}) {
    const auto heard = b.max_by(pair, offsets);
    joint = mlp<B>(b, Path("joint" + std::to_string(step)), {joint, heard}, {64});
    const auto backwards = b.rows(pair, tree.reverse);
    pair = mlp<B>(b, Path("pair" + std::to_string(step)), {pair, backwards, tree.pairs, {joint, receivers}, {joint, sources}}, {64});
  }
  return b.linear(Path("out"), pair, 1);
}

}  // namespace osteon::nets
