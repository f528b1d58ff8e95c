// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/mesh/triangle_mesh.h"

namespace osteon::geometry {

// What brings a mesh near the origin: far from it floats may be coarser than what is built around the mesh. A multiple of a power of two,
// so that no vertex is rounded; zero for a mesh that is within some eight of its sides already. Pre: the mesh has vertices.
Vec3f shift_to_origin(const TriangleMesh& mesh);

}  // namespace osteon::geometry
