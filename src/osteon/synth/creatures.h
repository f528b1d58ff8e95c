// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/base/random.h"
#include "osteon/synth/body.h"

// One file a kind of animal. Each draws its proportions from `random`, then builds the body from them: feet on about y = 0, facing +z.
namespace osteon::synth {

Body make_biped(Random& random);
Body make_quadruped(Random& random);
Body make_bird(Random& random);
Body make_fish(Random& random);
Body make_serpent(Random& random);
Body make_insect(Random& random);
Body make_spider(Random& random);
Body make_many_legged(Random& random);
Body make_many_armed(Random& random);
Body make_winged(Random& random);
Body make_tailed_biped(Random& random);
Body make_robot(Random& random);
Body make_blob(Random& random);
Body make_blocky_animal(Random& random);
Body make_blocky_humanoid(Random& random);

}  // namespace osteon::synth
