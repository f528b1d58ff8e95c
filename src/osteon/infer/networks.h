// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <span>

#include "osteon/base/types.h"
#include "osteon/nets/dry_run.h"
#include "osteon/nets/graph.h"

namespace osteon::infer {

// What the networks read; each needs the mesh (tree: only that it is there), and of the rest what its name says.
struct NetworkInput {
  const nets::MeshArrays& mesh;
  const nets::JointArrays* joints = nullptr;  // bones, root, tree
  const nets::PairArrays* pairs = nullptr;    // bones
  std::span<const float> skin_features = {};  // skin: (V,43)
  const nets::BindArrays* choices = nullptr;  // bind
  const nets::VoteArrays* votes = nullptr;
  const nets::TreeArrays* tree = nullptr;
  const nets::NeuroArrays* neuro = nullptr;
};

// The network's output as in nets/rignet.h (logits). Backend: Loops or Onednn; instantiated in networks.cpp.
template <class Backend>
Matrix run(nets::rignet::Network network, Backend& backend, const NetworkInput& input);

// One network with its weights, ready to run. Several threads may run it at the same time.
class NetworkRunner {
 public:
  virtual ~NetworkRunner() = default;
  virtual Matrix run(const NetworkInput& input) const = 0;
};

// Makes the runner of a network from its file of weights. Throws Error where the file cannot be used.
using RunnerFactory = std::function<std::unique_ptr<NetworkRunner>(nets::rignet::Network network, const std::filesystem::path& weights)>;

}  // namespace osteon::infer
