// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/io/gltf/document.h"
#include "osteon/io/scene.h"
#include "osteon/io/source_document.h"

namespace osteon::io::gltf {

struct Imported {
  Scene scene;                      // meshes, nodes and skins numbered as in the document
  std::vector<MeshLayout> layouts;  // one for each mesh
};

// The default scene of a document: its triangles (strips and fans unrolled), skins and nodes. Faces with an index out of range and
// primitives without positions are left out and said so in `repairs`. Throws Error naming the element for a broken reference or accessor.
Imported import_scene(const Document& document, std::vector<std::string>& repairs);

// node -> its parent.
Eigen::Affine3d local_transform(const Element& node);

}  // namespace osteon::io::gltf
