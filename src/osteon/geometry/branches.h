// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "osteon/geometry/neighbourhoods.h"

namespace osteon::geometry {

// A part of a surface that sticks out, as a finger does: from where a distance along the surface is largest down to where the part meets
// another such part.
struct Branch {
  VertexId tip;                         // the farthest vertex
  float top = 0.0f, base = 0.0f;        // the distance there, and where it meets the other; of the last of a piece the least distance
  std::optional<std::uint32_t> parent;  // what begins where it ends, the number of a later branch; none: the last of a piece
  std::vector<VertexId> vertices;       // its own, by falling distance

  float length() const { return top - base; }
};

// The join tree of the distance (Carr, Snoeyink, Axen. Computing contour trees in all dimensions. 2003): the pieces of the surface that
// are farther than d, as d falls from the largest distance to zero. A piece that is born and meets a longer one within `least` is no
// branch of its own; its vertices belong to the longer one. Children come before their parents. Vertices at infinity are left out.
// `ring`: one_ring() of the mesh. Pre: a distance for every vertex, `least` >= 0.
std::vector<Branch> branches(const Neighbourhoods& ring, std::span<const float> distance, float least);

}  // namespace osteon::geometry
