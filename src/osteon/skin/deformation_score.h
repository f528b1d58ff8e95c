// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "osteon/rig/rig.h"

namespace osteon::skin {

// How a skin holds when its joints bend one after the other. All 0 for a perfect skin; a rigid one has large stretch at its seams.
struct Deformation {
  double stretch = 0.0;      // mean |log| of the ratio by which edges get longer or shorter, over the edges near the joint
  double area = 0.0;         // the same of the faces' areas
  double flips = 0.0;        // share of those faces that turn over
  double volume_loss = 0.0;  // of the whole mesh's volume, mean over the poses where it shrinks; 0 for a mesh that encloses none
};

struct JointDeformation {
  JointId joint;
  Deformation score;
};

struct DeformationScore {
  Deformation mean;                      // over the joints
  std::vector<JointDeformation> joints;  // those that move something and leave something where it is, the largest stretch first
};

struct SweepOptions {
  float angle = 0.7853982f;  // radians: 45 degrees, about each of the three axes of the joint
};

// Turns every joint but the root by itself and looks at the faces that it moves in part. Pre: validate(rig) holds.
DeformationScore deformation_score(const Rig& rig, const SweepOptions& options = {});

}  // namespace osteon::skin
