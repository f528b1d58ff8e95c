// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/io/gltf/document.h"
#include "osteon/rig/motion.h"

namespace osteon::io::gltf {

// The nodes of a document in poses of all its animations (specification, section 3.11), `per_second` for each second: translations,
// rotations and scales; morph weights are left out. Cubic splines are read as straight lines between their key frames. Rest: the nodes'
// own transforms. Throws Error naming the element.
Motion poses_of(const Document& document, double per_second);

}  // namespace osteon::io::gltf
