// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "osteon/rig/rig.h"

namespace osteon::synth {

// A character with what it wears: garments' vertices and joints come after those of the body.
struct DressedCharacter {
  Rig rig;
  std::size_t body_vertices, body_joints;
};

// Clothes as production characters have them: open sheets beside the body that touch, cross and hang free of it. By the seed: a skirt, on
// chains of joints of its own or bound to hips and thighs; a cloak on three chains behind the back; wide sleeves, with a joint of their own
// or without. At least one of them. Weights are exact: linear between the joints that a point hangs between.
// Pre: `biped` is a biped of make_character (its joints' names are those of the generator).
DressedCharacter dressed(const Rig& biped, std::uint64_t seed);

}  // namespace osteon::synth
