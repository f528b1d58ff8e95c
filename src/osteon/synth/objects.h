// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "osteon/mesh/triangle_mesh.h"

namespace osteon::synth {

constexpr std::array<std::string_view, 14> kObjects{"ball",  "box",  "sheet", "ring",   "rock",  "rods",  "chair",
                                                    "table", "vase", "house", "stairs", "shelf", "wheel", "scraps"};

// A thing that is no character, of random proportions, about 1 m large: what an auto-rigger ought to refuse. The same seed, the same thing.
// Pre: kind < kObjects.size().
TriangleMesh make_object(std::size_t kind, std::uint64_t seed);

}  // namespace osteon::synth
