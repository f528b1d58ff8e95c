// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/rig/skeleton.h"

namespace osteon::dataset {

// What skinning does to each joint's part, rest -> changed: v -> linear (v - joint) + moved joint.
struct Articulation {
  PerJoint<Eigen::Matrix3f> linear;  // rotation times size
  PerJoint<Vec3f> joints;            // where the joints go
};

}  // namespace osteon::dataset
