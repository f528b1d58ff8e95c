// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/io/source_document.h"

namespace osteon::io::gltf {

// A new document with one node and one mesh: a primitive for each material, vertices doubled where corners differ in normal or texture
// coordinate, smooth normals where the input had none. Faces that name a vertex twice are left out.
// `name` is given to the mesh and its node. Pre: the mesh is valid and has a face.
GltfSource fresh_document(const std::string& name, const TriangleMesh& mesh, const Appearance& appearance,
                          std::vector<std::string>& changes);

// The one instance of a fresh document.
std::vector<PlacedInstance> fresh_instances();

}  // namespace osteon::io::gltf
