// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "osteon/io/gltf/writer.h"
#include "osteon/io/save.h"

namespace osteon::io::gltf {

// The influences of `vertices`, cut to options.max_influences, as accessors JOINTS_0, WEIGHTS_0 (and JOINTS_1, WEIGHTS_1 above 4).
// Sorted by weight; unused slots have joint 0 and weight 0; float sums are within 1e-7 of 1, integer sums exact.
// Returns what to put into a primitive's attributes.
Json add_skin_attributes(Writer& writer, std::span<const VertexId> vertices, const SkinWeights& weights, std::size_t joints,
                         const SaveOptions& options);

// Integers that sum to exactly `total` and are as near to weights * total as that allows (largest remainders, ties to the first).
// Pre: the weights are positive and sum to 1.
std::vector<std::uint32_t> quantized(std::span<const float> weights, std::uint32_t total);

}  // namespace osteon::io::gltf
