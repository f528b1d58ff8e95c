// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "osteon/mesh/triangle_mesh.h"

namespace osteon::synth {

// The surface where `distance` is 0, as one triangle mesh that faces outwards (to positive values): a vertex in every cubic cell of edge
// length `cell` that the surface passes, set on the surface, and a quadrilateral across every cell edge that it cuts, split in two.
// Gibson, "Constrained Elastic SurfaceNets", 1998, in the plain dual form. The grid is symmetric about x = 0 and so is the result for a
// symmetric function. Empty space is skipped: pre: |distance(p)| is at most the distance from p to the surface, and `box` holds it.
// Ambiguous cells can give an edge with four faces; the mesh has no border.
TriangleMesh polygonize(const std::function<float(const Vec3f&)>& distance, const Eigen::AlignedBox3f& box, float cell);

}  // namespace osteon::synth
