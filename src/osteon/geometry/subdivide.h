// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "osteon/mesh/triangle_mesh.h"

namespace osteon::geometry {

struct SubdivideOptions {
  std::size_t most_vertices;  // stop when there are as many
  float longest_edge = 0;     // or when no edge is longer
};

// Halves the longest edge, again and again, and with it all of its faces, so that no cracks arise. The surface does not change; triangles
// do not get thinner than about half the smallest angle (Rosenberg and Stenger, "A lower bound on the angles of triangles constructed by
// bisecting the longest side", 1975). Vertices and faces keep their numbers, new ones follow; of equally long edges the one with the
// smaller vertices is first. Pre: validate(mesh) holds.
TriangleMesh subdivide(TriangleMesh mesh, const SubdivideOptions& options);

}  // namespace osteon::geometry
