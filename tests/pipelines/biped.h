// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/synth/character.h"

namespace osteon::test {

inline Rig biped() { return synth::make_character(synth::Kind::Biped, 3, {64, synth::Finish::Smooth}); }

}  // namespace osteon::test
