// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>

#include "osteon/rig/skeleton.h"

namespace osteon::bench {

// The same tree with every bone cut into so many: more joints in the same body.
inline Skeleton with_bones_cut(const Skeleton& skeleton, int parts) {
  Skeleton out;
  PerJoint<JointId> place(skeleton.size());
  for (JointId j : skeleton.names.ids()) {
    const auto& parent = skeleton.parents[j];
    std::optional<JointId> above;
    if (parent) above = place[*parent];
    for (int k = 1; parent && k < parts; ++k) {
      const float t = static_cast<float>(k) / static_cast<float>(parts);
      const Vec3f p = (1.0f - t) * skeleton.rest_positions[*parent] + t * skeleton.rest_positions[j];
      above = out.add(skeleton.names[j] + "_" + std::to_string(k), above, p, skeleton.rest_orientations[*parent]);
    }
    place[j] = out.add(skeleton.names[j], above, skeleton.rest_positions[j], skeleton.rest_orientations[j]);
  }
  return out;
}

}  // namespace osteon::bench
