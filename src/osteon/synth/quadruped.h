// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "osteon/synth/body.h"
#include "osteon/synth/habits.h"
#include "osteon/synth/head.h"
#include "osteon/synth/wing.h"

namespace osteon::synth {

// In metres; lengths of a middling dog where a factor is 1.
struct QuadrupedShape {
  float size, length, height, build;      // factors
  float belly, legs;                      // factors: girth of the middle, thickness of the legs
  float neck, neck_rise;                  // factor; 0 hangs low .. 1 stands up
  float bend;                             // of the legs: 0 as straight as an elephant's
  float tail, tail_thickness, tail_rise;  // factors; -1 hangs .. 1 stands
  HeadShape head;
  std::optional<WingShape> wings;

  explicit QuadrupedShape(Random& random);
};

Body make_quadruped(const QuadrupedShape& shape, const Habits& habits);

}  // namespace osteon::synth
