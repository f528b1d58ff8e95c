// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/synth/body.h"
#include "osteon/synth/habits.h"

namespace osteon::synth {

struct HandShape {
  float size = 1.0f;  // of a grown man where it is 1
  int fingers = 4;    // beside the thumb; 0: a mitten
  std::string name;   // before the names of its joints, where a body has several pairs
};

// Adds "LeftHand" and its fingers below the forearm on the left, and their twins. The palm lies flat, facing down where the arm points
// sideways; the thumb points forwards. `along` is of unit length. Returns the left hand.
JointId add_hand(Body& body, JointId forearm, const Vec3f& wrist, const Vec3f& along, const HandShape& shape, const Habits& habits);

}  // namespace osteon::synth
