// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/synth/body.h"
#include "osteon/synth/habits.h"
#include "osteon/synth/head.h"

namespace osteon::synth {

// A body that stands upright on two legs. In metres, of an adult where a factor is 1.
struct BipedShape {
  float size, build, belly, torso, legs, arms, shoulders, hands, feet;  // factors; belly: girth of the waist
  float arm_angle, elbow, knee;                                         // radians: arms below horizontal (0 is a T-pose), bends
  int arm_pairs, fingers;                                               // fingers beside the thumb; 0: a mitten
  float tail, tail_thickness;                                           // factors; 0: none
  HeadShape head;
  Outfit outfit;

  explicit BipedShape(Random& random);
};

Body make_biped(const BipedShape& shape, const Habits& habits);

}  // namespace osteon::synth
