// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

#include "osteon/rig/motion.h"

namespace osteon::io::bvh {

// The joints of a BVH in its poses, `per_second` for each second. Angles turn about the axes in the order of a joint's channels; position
// channels, of the root or of any other joint, stand in place of its OFFSET. Rest: all angles zero, every joint at its OFFSET. World of the
// file, whatever its unit and axes. Throws Error naming `file`, the line, what was found and what was expected.
Motion poses_of(const std::string& file, std::string_view text, double per_second);

}  // namespace osteon::io::bvh
