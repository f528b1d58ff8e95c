// SPDX-License-Identifier: Apache-2.0
#include "osteon/rig/rig.h"

namespace osteon {

void validate(const Rig& rig) {
  validate(rig.mesh);
  validate(rig.skeleton);
  validate(rig.weights, rig.mesh.positions.size(), rig.skeleton.size());
}

}  // namespace osteon
