// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "osteon/mesh/triangle_mesh.h"

namespace osteon::geometry {

struct SymmetryOptions {
  float tolerance = 0.012f;  // accepted mean distance between surface and mirrored surface, in parts of the bounding box's diagonal
};

// The plane in which the shape mirrors itself, found and not assumed; none where nothing comes near enough. Of several planes about equally
// good the most x = 0 like wins (normal along x, else horizontal). The normal's largest component is positive: a character that faces +z
// has its left on the positive side. Candidates (axes, principal axes of the surface, turns of them where these are not unique) are refined
// by iterated closest points: the reflection that best takes samples to the surface points next to their images is an eigenvector problem.
// Depends on the shape and not on the order of vertices where `mesh` is in canonical order.
std::optional<Plane> symmetry_plane(const TriangleMesh& mesh, const SymmetryOptions& options = {});

}  // namespace osteon::geometry
