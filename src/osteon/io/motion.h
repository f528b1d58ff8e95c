// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "osteon/io/bytes.h"
#include "osteon/rig/motion.h"

namespace osteon::io {

// Poses of a GLB or glTF (all nodes; all its animations, one after the other) or else of a BVH, `per_second` for each second and the first
// at least. `path` is for messages, and to find buffers beside it. Throws Error naming the file and the element: when it is neither of
// these, is broken, or when nothing moves in it.
Motion read_motion(const std::filesystem::path& path, Bytes bytes, double per_second);

}  // namespace osteon::io
