// SPDX-License-Identifier: Apache-2.0
#include "osteon/synth/habits.h"

namespace osteon::synth {

Habits::Habits(Random& random) {
  const float detail = random.uniform();
  const auto chance = [&](float offset) { return random.uniform() < detail + offset; };
  const auto number = [&](int least, int most) {
    return least + static_cast<int>(random.below(static_cast<std::size_t>(most - least + 1)));
  };
  const bool plain = detail < 0.15f;  // as for crowds and small toys
  knees = !plain;
  spine = plain ? number(0, 1) : number(1, detail < 0.4f ? 2 : 4);
  neck = plain ? 0 : number(0, detail < 0.4f ? 1 : 2);
  tail = plain ? 1 : number(2, detail < 0.4f ? 3 : 6);
  phalanges = chance(0.0f) ? number(detail < 0.5f ? 1 : 2, 3) : 0;
  clavicles = !plain && chance(0.3f);
  ankles = !plain && chance(0.5f);
  toes = ankles && chance(0.1f);
  jaw = chance(-0.4f);
  eyes = chance(-0.5f);
  ears = chance(0.0f);
  ends = random.uniform() < 0.35f;
  root = random.below(2) == 0 ? 0.0f : random.uniform(0.3f, 1.0f);
}

}  // namespace osteon::synth
