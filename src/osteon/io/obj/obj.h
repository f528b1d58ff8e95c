// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/io/importer.h"

namespace osteon::io::obj {

// Wavefront OBJ: vertices with optional colours, polygons of any number of corners, negative indices, materials with their MTL file.
// Groups, objects, lines and curves are passed over. Vertices keep their order and number.
Scene import(const File& file);

}  // namespace osteon::io::obj
