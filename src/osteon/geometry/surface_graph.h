// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "osteon/mesh/triangle_mesh.h"

namespace osteon::geometry {

// An undirected graph over the vertices of a mesh whose shortest paths stand for distances along the surface.
struct SurfaceGraph {
  struct Edge {
    std::uint32_t to;
    float length;  // in the mesh's unit
  };
  std::vector<std::uint32_t> offsets{0};  // V + 1
  std::vector<Edge> edges;                // of vertex v: edges[offsets[v] .. offsets[v + 1]), ascending by `to`

  std::size_t size() const { return offsets.size() - 1; }
  std::span<const Edge> of(std::size_t v) const { return std::span(edges).subspan(offsets[v], offsets[v + 1] - offsets[v]); }
};

// Edges:
// - those of the mesh;
// - across every edge with two faces, the straight line between the two far corners in the faces unfolded into a plane, where it stays
//   inside them: paths need not zigzag along edges;
// - bridges between different components that lie on each other (cloth on a body, hair cards, open seams): from a vertex to the corners of
//   the nearest face of each other component, if within `bridge`. Faces whose normal disagrees with the vertex's do not count (cosine <= -0.5, as
//   in RigNet's sample graph: the two sides of a thin part, or two limbs that touch). Vertices without faces have no normal and agree with all.
SurfaceGraph surface_graph(const TriangleMesh& mesh, float bridge);
SurfaceGraph surface_graph(const TriangleMesh& mesh);  // without bridges

struct Link {
  std::uint32_t from, to;
  float length;
};

// The graph with further edges; of several between the same two vertices the shortest stays.
SurfaceGraph with_links(const SurfaceGraph& graph, std::span<const Link> links);

// Smallest start[s] + length of a path from s, over all s, for every vertex; infinity where no path leads from a finite start.
// Pre: start has V items, >= 0 or infinite.
std::vector<float> shortest_paths(const SurfaceGraph& graph, std::vector<float> start);

}  // namespace osteon::geometry
