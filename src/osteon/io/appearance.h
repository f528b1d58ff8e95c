// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/io/source_document.h"

namespace osteon::io {

// Normals, texture coordinates, colours, materials, objects and morphs of all instances, in the order in which assemble() merged their
// vertices and faces.
Appearance merged_appearance(const Scene& scene, const std::vector<PlacedInstance>& instances);

}  // namespace osteon::io
