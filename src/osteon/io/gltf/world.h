// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/io/gltf/document.h"
#include "osteon/io/scene.h"

namespace osteon::io::gltf {

// Brings all that a document shows to the world that `to_world` (a similarity) leads to, by a node above each root of its trees; nothing
// below changes. Skinned meshes that stand at the top follow their joints, so they stay there. `scene` is the document's.
void bring_to_world(Document& document, const Scene& scene, const Eigen::Affine3d& to_world);

}  // namespace osteon::io::gltf
