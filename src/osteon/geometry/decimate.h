// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>

#include "osteon/mesh/triangle_mesh.h"

namespace osteon::geometry {

struct DecimateOptions {
  std::size_t target_vertices = 1200;
  std::size_t most_vertices = SIZE_MAX;  // where no more can be merged without folding faces, they are folded down to so many
  // How much even spacing counts against fidelity: the weight of squared distances between a vertex and all those it stands for, beside
  // squared distances to their planes. 0.01 gives flat and mildly curved regions triangles of about equal size and thin parts smaller ones.
  double spread = 0.01;
};

struct DecimatedMesh {
  TriangleMesh mesh;
  PerVertex<VertexId> from_input;  // input vertex -> the vertex that it was merged into, over a chain of edges of the input
};

// Merges neighbouring vertices until about target_vertices are left, cheapest first. Garland and Heckbert 1997, edges only (never across
// gaps), with planes along open borders (section 6) and a fold-over test (section 7; see most_vertices). Differs: planes are weighted by
// area; a point term keeps the spacing even (see spread); and edges are not kept in one queue but sorted in rounds, in which a vertex is
// merged at most once, many edges a round at first and few near the target, which is faster and chooses nearly the same. What is thinner
// than its edges may become flat: straps, buckles and meshes full of holes do not eat up the vertices that the body needs. But nothing
// comes apart: components stay what they are, each with at least one face, even if the target is missed. Vertices without faces stay as
// they are. Result: vertices in the order of the input's. Pre: validate(mesh) holds.
DecimatedMesh decimate(const TriangleMesh& mesh, const DecimateOptions& options);

}  // namespace osteon::geometry
