// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/io/source_document.h"

namespace osteon::io::gltf {

// A new document, and how the mesh stands in it.
struct Fresh {
  GltfSource source;
  std::vector<PlacedInstance> instances;  // one for each of its meshes
};

// A node and a mesh for each object, with a primitive for each material; vertices doubled where corners differ in normal or texture
// coordinate, smooth normals where the input had none. Faces that name a vertex twice are left out.
// `name` is given to the objects that have none. Pre: the mesh is valid and has a face.
Fresh fresh_document(const std::string& name, const TriangleMesh& mesh, const Appearance& appearance, std::vector<std::string>& changes);

}  // namespace osteon::io::gltf
