// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "osteon/mesh/triangle_mesh.h"

namespace osteon::geometry {

struct CleanMesh {
  TriangleMesh mesh;
  PerVertex<VertexId> from_original;  // original vertex -> clean vertex; one that no face uses goes to the nearest clean vertex
  std::vector<std::string> repairs;   // one sentence for each kind of repair; empty when nothing was wrong
};

// The same surface as one would model it: each point once, each face once, nothing without area, in an order that does not depend on the
// order of the input's vertices and faces (any permutation, and any rotation of a face's corners, gives the same bytes).
// - Vertices at equal positions become one where they belong to one surface: index buffers are split along texture seams and hard edges.
//   Parts that only touch stay apart, though their positions coincide: two parts are sewn together only along edges that are open in both.
// - Faces with two equal corners or without area go, and so do copies (with reversed corners too, if of the same part).
// - Vertices that no face uses go. When no face is left, all vertices stay, so that from_original has a target.
// - Vertices are sorted by x, y, z, faces by their corners, a face starts with its smallest corner.
// Pre: validate(mesh) holds.
CleanMesh clean(const TriangleMesh& mesh);

}  // namespace osteon::geometry
