// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/mesh/triangle_mesh.h"

namespace osteon::geometry {

// Signs that a mesh is not one whole character, for warnings: it is rigged as what it is. Only along the horizontal
// axes, so the mesh is to be turned as its file has it: bodies are cut and set side by side along them. In the training and
// validation characters there is none of either, and all that were cut in half or doubled for a trial are found.
// `up`: 0..2. Pre: validate(mesh) holds; vertices at one position of one surface are one (geometry/cleanup.h).

// More than half of the open border's length lies in one side of the bounding box, over 0.4 of its width and height: the half that a
// modelling program mirrors, or a part cut off.
bool is_open_at_a_side(const TriangleMesh& mesh, Eigen::Index up);

// A plane divides the mesh, touching no part, into two with two fifths of the area or more each: two characters, or one and its coarser
// copy.
bool stands_side_by_side(const TriangleMesh& mesh, Eigen::Index up);

}  // namespace osteon::geometry
