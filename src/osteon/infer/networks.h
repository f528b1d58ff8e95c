// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "osteon/base/types.h"
#include "osteon/nets/dry_run.h"
#include "osteon/nets/graph.h"

namespace osteon::infer {

// What the networks read; each needs the mesh, and of the rest what its name says.
struct NetworkInput {
  const nets::MeshArrays& mesh;
  const nets::JointArrays* joints = nullptr;  // bones, root
  const nets::PairArrays* pairs = nullptr;    // bones
  std::span<const float> skin_features = {};  // skin: (V,43)
  const nets::BindArrays* choices = nullptr;  // bind
  const nets::VoteArrays* votes = nullptr;
  const nets::NeuroArrays* neuro = nullptr;
};

// The network's output as in nets/rignet.h (logits). Backend: Loops or Onednn; instantiated in networks.cpp.
template <class Backend>
Matrix run(nets::rignet::Network network, Backend& backend, const NetworkInput& input);

}  // namespace osteon::infer
