// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "osteon/mesh/triangle_mesh.h"

namespace osteon::geometry {

// The mesh with the faces of those components turned that enclose a negative volume.
TriangleMesh faced_outwards(TriangleMesh mesh, const Components& parts);

// Turns the components that are clearly inside out, if they have a quarter of the whole area or more: a body that was mirrored without its
// faces, a hull for outlines. Mouths and eye sockets, which are seen from within, stay. Returns how many faces were turned.
std::size_t turn_inside_out(TriangleMesh& mesh);

}  // namespace osteon::geometry
