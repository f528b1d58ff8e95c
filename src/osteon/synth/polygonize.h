// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "osteon/mesh/triangle_mesh.h"

namespace osteon::synth {

using Field = std::function<float(const Vec3f&)>;
// The field for points within `radius` of `centre`: one made of many parts can leave out those that do not matter there.
using LocalField = std::function<Field(const Vec3f& centre, float radius)>;

// The surface where the field is 0, as one triangle mesh that faces outwards (to positive values): a vertex in every cubic cell of edge
// length `cell` that the surface passes, set on the surface, and a quadrilateral across every cell edge that it cuts, split in two.
// Gibson, "Constrained Elastic SurfaceNets", 1998, in the plain dual form. The grid is symmetric about x = 0 and so is the result for a
// symmetric field. Empty space is skipped: pre: a value's magnitude is at most the distance to the surface, and `box` holds it.
// Ambiguous cells can give an edge with four faces; the mesh has no border.
TriangleMesh polygonize(const LocalField& field, const Eigen::AlignedBox3f& box, float cell);

}  // namespace osteon::synth
