// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "osteon/mesh/triangle_mesh.h"

namespace osteon::geometry {

// The mesh with the faces of those components turned that enclose a negative volume.
TriangleMesh faced_outwards(TriangleMesh mesh, const Components& parts);

// Turns faces so that all which hang together look to the same side, where a surface has two: that of the greater part of its area. Faces
// hang together across edges that two of them have. Where less than a twentieth of all area looks the wrong way, it stays: artists leave
// that, and the networks learned from it. Returns how many were turned. Pre: no face has two equal corners.
std::size_t turn_against_neighbours(TriangleMesh& mesh);

// Turns the components that are clearly inside out, if they have a quarter of the whole area or more: a body that was mirrored without its
// faces, a hull for outlines. Mouths and eye sockets, which are seen from within, stay. Returns how many faces were turned.
std::size_t turn_inside_out(TriangleMesh& mesh);

}  // namespace osteon::geometry
