// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "osteon/base/random.h"

namespace osteon::synth {

// Where an artist puts joints in a body whatever its shape: the same character is rigged in many ways. Drawn from a seed; habits agree
// with one another, as who rigs fingers rarely leaves out the clavicles.
struct Habits {
  bool knees;                                           // and elbows; without them a limb is one joint
  int spine;                                            // joints of the trunk, 0..4, the root not counted
  int neck;                                             // 0..2
  int tail;                                             // 1..6
  int phalanges;                                        // joints of each finger, 0..3; 0: fingers belong to the hand
  bool clavicles, ankles, toes, jaw, eyes, ears, ends;  // ends: leaf joints at the tips, which bind nothing
  float root;                                           // height of the root: 0 between the hip joints .. 1 at the waist

  explicit Habits(Random& random);
};

// The name where a joint is wanted, else the empty name of a point without one.
inline std::string joint_if(bool wanted, const std::string& name) { return wanted ? name : ""; }

}  // namespace osteon::synth
