// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "osteon/dataset/prepared.h"
#include "osteon/mesh/shapes.h"
#include "osteon/rig/rig.h"

namespace osteon::test {

// A capsule of height 2.4 along y with joints at 0, 1 and 2 (a chain) and weights that blend from one to the next, half way between them.
inline Rig capsule_character() {
  Rig rig;
  rig.mesh = shapes::capsule(0.2f, 2.0f, 24, 12);
  const JointId low{0}, middle{1}, high{2};
  rig.skeleton.add("low", std::nullopt, Vec3f(0, 0, 0));
  rig.skeleton.add("middle", low, Vec3f(0, 1, 0));
  rig.skeleton.add("high", middle, Vec3f(0, 2, 0));
  for (const Vec3f& p : rig.mesh.positions) {
    const float to_middle = std::clamp(2.0f * p.y() - 1.5f, 0.0f, 1.0f), to_high = std::clamp(2.0f * p.y() - 3.5f, 0.0f, 1.0f);
    rig.weights.append(std::vector<Influence>{{low, 1.0f - to_middle}, {middle, to_middle - to_high}, {high, to_high}});
  }
  return rig;
}

// The same as the trainer holds it, at about 300 vertices.
inline const dataset::PreparedCharacter& prepared_capsule() {
  static const dataset::PreparedCharacter prepared = [] {
    dataset::PrepareOptions options;
    options.working_mesh = {300, 200, 5000};
    return dataset::prepare(capsule_character(), {"capsule", "capsules", "other"}, options);
  }();
  return prepared;
}

}  // namespace osteon::test
