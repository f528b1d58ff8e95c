// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "osteon/base/types.h"

namespace osteon {

// How joints move: the poses of an animation. Each pose stands by itself, so nothing is said of the tree or of time.
// Invariants: `rest` and every pose have as many items as there are names.
struct Motion {
  std::vector<std::string> names;             // UTF-8
  std::vector<Transform> rest;                // joint -> world of the file, in its unit; the pose that the joints are bound in
  std::vector<std::vector<Transform>> poses;  // the same, posed
};

}  // namespace osteon
