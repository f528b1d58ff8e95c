// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/synth/accessories.h"
#include "osteon/synth/body.h"
#include "osteon/synth/habits.h"

namespace osteon::synth {

// Lengths are in radii of the skull.
struct HeadShape {
  float radius = 0.1f;        // of the skull, metres
  float width = 0.9f;         // of the skull, by its height: at most 1
  float forward = 0.0f;       // 0: the skull stands above its joint, as on a man .. 1: it lies before it, as on a dog
  float snout = 0.0f;         // 0: a flat face
  float snout_width = 0.55f;  // a beak is narrow
  float eyes = 0.0f;          // radius of eyeballs, which are pieces of their own; 0: none
  float ears = 0.0f;          // length; 0: none
  float ear_spread = 0.4f;    // 0 upwards .. 1 sideways
  float horns = 0.0f, horn_curl = 0.3f;
  Headgear headgear = Headgear::None;
};

// Adds "Head" below `parent`, facing +z, with "Jaw", "LeftEye", "LeftEar", ... as the habits have it; returns the head's joint.
JointId add_head(Body& body, JointId parent, const Vec3f& at, const HeadShape& shape, const Habits& habits);

}  // namespace osteon::synth
