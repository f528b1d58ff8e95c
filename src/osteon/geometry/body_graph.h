// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/geometry/body_lines.h"
#include "osteon/geometry/surface_graph.h"

namespace osteon::geometry {

// A graph over the vertices of a mesh whose shortest paths stand for distances through the body and over its surface. Connected. Beside the
// edges of surface_graph(mesh, bridge):
// - chords: from a vertex to the corners of the faces that seven lines inwards meet on the other side, so that paths need not go around a
// limb,
//   a wing or a mouth. They start and end on one body and so do not jump to what only lies near.
// - for each piece that nothing else connects, the shortest link between vertices to another piece, until all hang together.
SurfaceGraph body_graph(const TriangleMesh& mesh, const BodyLines& lines, float bridge);

}  // namespace osteon::geometry
