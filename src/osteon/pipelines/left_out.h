// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "osteon/geometry/surroundings.h"
#include "osteon/rig/skin_weights.h"

// For a character from whose mesh its surroundings were left out (geometry::without).
namespace osteon::pipelines {

// Weights of all vertices: what is not the character follows the root.
SkinWeights with_surroundings(const SkinWeights& of_character, const geometry::Surroundings& around);

// What the user should know.
std::string note_of(const geometry::Surroundings& around);

}  // namespace osteon::pipelines
