// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/mesh/triangle_mesh.h"

namespace osteon::geometry {

// The bounding box of the shape: of the vertices that faces use, as others may lie anywhere. Empty without faces.
Eigen::AlignedBox3f box_of_faces(const TriangleMesh& mesh);

}  // namespace osteon::geometry
