// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "osteon/geometry/neighbourhoods.h"
#include "osteon/mesh/triangle_mesh.h"

namespace osteon::geometry {

// A surface cut into regions of about equal size: few enough that each can be compared with all others, so that a vertex learns what the
// whole limb and the whole body are like, of which its neighbourhood shows little.
struct Regions {
  std::vector<std::uint32_t> seeds;      // (R) the vertex in the middle of each region
  std::vector<std::uint32_t> region_of;  // (V) the region of each vertex
};

// Farthest point sampling along the surface: the first seed is `first`, each further one the vertex farthest from all before it (ties: the
// smaller index); a vertex belongs to the nearest seed. Ways lead over the eight nearest members of the balls, and vertices that none
// reaches go by straight distance, so a part that hangs together with nothing gets a region of its own while there are any left.
// R = min(count, V). Pre: V > 0, count > 0, first < V.
Regions regions(const TriangleMesh& mesh, const GeodesicBalls& balls, std::size_t count, std::uint32_t first);

// The vertex farthest from the middle of all (ties: the smaller index): a first seed that depends on nothing but the shape.
std::uint32_t outermost_vertex(const TriangleMesh& mesh);

}  // namespace osteon::geometry
