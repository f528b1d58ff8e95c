// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ATen/ATen.h>

#include "osteon/nets/dry_run.h"
#include "osteon/nets/graph.h"
#include "osteon/train/norm_rule.h"
#include "osteon/train/parameters.h"

// RigNet's networks on LibTorch. The templates are instantiated in networks.cpp alone, as torch's headers take long to compile.
namespace osteon::train {

enum class Mode { training, use };   // normalise with the figures of the batch, and keep the running ones up to date; or with these
// The same function three ways: LibTorch operations on any device; hand-written layers for the CPU; few passes over memory, for a GPU.
enum class Engine { plain, fused, device };

using nets::NetworkInputs;

struct RunOptions {
  Mode mode = Mode::use;
  Engine engine = Engine::fused;
  at::Device device = at::kCPU;
  NormRule norm = {};  // in training
};

// The network's output, see nets/rignet.h.
at::Tensor run_network(nets::rignet::Network network, Parameters& parameters, const NetworkInputs& inputs, const RunOptions& options);

}  // namespace osteon::train
