// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/synth/body.h"
#include "osteon/synth/habits.h"

namespace osteon::synth {

enum class WingStyle { Feathered, Webbed };  // a thick flat arm; a thin arm with a web behind it
struct WingShape {
  WingStyle style = WingStyle::Feathered;
  Vec3f shoulder = Vec3f::Zero();   // on the left
  float span = 0.5f;                // of one wing, metres
  float chord = 0.3f;               // from front to back, spans
  float rise = 0.1f, sweep = 0.1f;  // of the tip, spans: upwards, backwards
  int joints = 3;                   // along the wing
};

// Adds a pair of spread wings, "LeftWing", "LeftWing1", ..., below `parent`.
void add_wings(Body& body, JointId parent, const WingShape& shape, const Habits& habits);

}  // namespace osteon::synth
