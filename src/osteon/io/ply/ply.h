// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/io/importer.h"

namespace osteon::io::ply {

// Stanford PLY: ascii, binary little and big endian; vertices with normals, colours (taken as sRGB) and texture coordinates; faces of any
// number of corners with MeshLab's texture coordinates per corner; triangle strips. Other elements and properties are passed over.
Scene import(const File& file);

}  // namespace osteon::io::ply
