// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <numeric>

#include "osteon/base/random.h"
#include "osteon/base/safetensors.h"
#include "osteon/infer/rignet.h"
#include "osteon/nets/dry_run.h"
#include "support/expect.h"

namespace osteon::test {

using nets::rignet::Network;
enum class LastLayer { random, zero };

// Seeded random parameters of a network: uniform as a linear layer starts, normalisation near the identity.
inline Safetensors random_parameters(Network network, std::uint64_t seed, LastLayer last = LastLayer::random) {
  Random random(seed);
  Safetensors content;
  for (const auto& [name, shape] : nets::rignet::parameter_shapes(network)) {
    const auto count = std::accumulate(shape.begin(), shape.end(), std::int64_t{1}, std::multiplies());
    const float bound = shape.size() == 2 ? 1.5f / std::sqrt(static_cast<float>(shape[1])) : 0.1f;
    std::vector<float> values(static_cast<std::size_t>(count), 0.0f);
    const bool is_variance = name.ends_with("running_var");
    if (last == LastLayer::random || !name.starts_with("out."))
      for (float& v : values) v = is_variance ? random.uniform(0.5f, 1.5f) : random.uniform(-bound, bound);
    content.arrays[name] = Array::of<float>(values, shape);
  }
  return content;
}

// Networks that were never trained.
inline infer::RignetModels untrained_models(std::initializer_list<Network> networks, LastLayer last = LastLayer::random) {
  const TemporaryFolder folder;
  std::uint64_t seed = 1;
  for (const Network network : networks)
    save_safetensors(folder / (std::string(nets::rignet::name_of(network)) + ".safetensors"), random_parameters(network, seed++, last));
  return infer::RignetModels::load(folder.path());
}

}  // namespace osteon::test
