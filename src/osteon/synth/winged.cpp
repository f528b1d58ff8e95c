// SPDX-License-Identifier: Apache-2.0
#include "osteon/synth/creatures.h"
#include "osteon/synth/quadruped.h"

namespace osteon::synth {
namespace {

void become_dragon(QuadrupedShape& shape, Random& random) {
  shape.neck = random.uniform(1.0f, 2.8f);
  shape.tail = random.uniform(1.2f, 3.0f);
  shape.tail_thickness = random.uniform(1.4f, 2.4f);
  shape.head.snout = random.uniform(0.7f, 1.6f);
  shape.head.horns = random.uniform(0.0f, 1.8f);
  shape.head.horn_curl = random.uniform(-1.0f, 0.2f);
  shape.wings = WingShape{.style = WingStyle::Webbed};
  shape.wings->chord = random.uniform(0.35f, 0.7f);
}

void become_pegasus(QuadrupedShape& shape, Random& random) {
  shape.wings = WingShape{.style = WingStyle::Feathered};
  shape.wings->chord = random.uniform(0.25f, 0.4f);
}

}  // namespace

Body make_winged(Random& random) {
  QuadrupedShape shape(random);
  if (random.below(3) != 0)
    become_dragon(shape, random);
  else
    become_pegasus(shape, random);
  shape.wings->span = random.uniform(0.4f, 1.0f);
  shape.wings->rise = random.uniform(0.0f, 0.8f);
  shape.wings->sweep = random.uniform(0.0f, 0.4f);
  shape.wings->joints = 2 + static_cast<int>(random.below(4));
  return make_quadruped(shape, Habits(random));
}

}  // namespace osteon::synth
