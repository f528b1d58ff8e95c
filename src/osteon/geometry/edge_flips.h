// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/base/random.h"
#include "osteon/mesh/triangle_mesh.h"

namespace osteon::geometry {

struct EdgeFlipOptions {
  float share = 0.3f;      // of the edges that may be flipped
  float bend = 0.2f;       // radians: the most that the normals of the two faces, before and after, may differ
  float roundness = 0.2f;  // the least of a face that a flip makes: twice its area by the square of its longest side (0.87: equilateral)
};

// The same surface with other triangles, as another artist's program might have cut it: a random share of the edges between two nearly
// coplanar faces is replaced by the other diagonal of the two. Vertices stay, so does what belongs to them; edges at borders, and where
// three faces meet or orientations differ, stay too, and no edge comes to be twice. In random order, each face at most once.
TriangleMesh with_flipped_edges(TriangleMesh mesh, const EdgeFlipOptions& options, Random& random);

}  // namespace osteon::geometry
