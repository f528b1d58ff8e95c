// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "osteon/mesh/triangle_mesh.h"

namespace osteon::render {

// A unit normal for each corner of each face: the area-weighted mean over the faces around the corner's place that are turned less than
// `crease` (radians) against this face. Vertices at exactly one place count as one, so that texture seams do not show. A face without area
// gets (0,0,1).
PerFace<std::array<Vec3f, 3>> corner_normals(const TriangleMesh& mesh, float crease = 0.9f);

}  // namespace osteon::render
