// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "osteon/base/random.h"
#include "osteon/mesh/triangle_mesh.h"

namespace osteon::geometry {

// The neighbours of every vertex (itself excluded), one row after the other: row v is members[offsets[v] .. offsets[v + 1]).
struct Neighbourhoods {
  std::vector<std::uint32_t> offsets{0};  // V + 1
  std::vector<std::uint32_t> members;     // vertex indices

  std::size_t size() const { return offsets.size() - 1; }  // V
  std::span<const std::uint32_t> of(std::size_t v) const { return std::span(members).subspan(offsets[v], offsets[v + 1] - offsets[v]); }
  bool operator==(const Neighbourhoods&) const = default;
};

// All other vertices of a vertex's faces, each once, ascending (RigNet's "tpl" edges). Empty for a vertex that no face uses.
Neighbourhoods one_ring(const TriangleMesh& mesh);

// The vertices near each vertex along the surface, nearest first (ties: the smaller index), and how far they are.
struct GeodesicBalls {
  Neighbourhoods members;
  std::vector<float> distances;  // parallel to members.members, in the mesh's unit

  std::span<const float> distances_of(std::size_t v) const {
    return std::span(distances).subspan(members.offsets[v], members.offsets[v + 1] - members.offsets[v]);
  }
};

// RigNet's geodesic neighbourhoods (sec. 3.1), by exact shortest paths in surface_graph(mesh, radius / 3), cut off at `radius`, which is in
// the mesh's unit (normalised: longest side 1). A ball keeps its `most` nearest members: the networks take 10 to 15 of them.
// Differs from the reference, which walks over 4000 random surface samples and gives vertices of one sample the distance 0 (14-53 % of
// all).
GeodesicBalls geodesic_balls(const TriangleMesh& mesh, float radius = 0.06f, std::size_t most = 64);

// At most `most` members of each ball, evenly spread over its ranks, so near and far ones alike; nearest first. For use.
Neighbourhoods evenly(const GeodesicBalls& balls, std::size_t most);

// At most `most` members of each ball, drawn without replacement; nearest first. For training: drawn anew for every batch.
Neighbourhoods drawn(const GeodesicBalls& balls, std::size_t most, Random& random);

}  // namespace osteon::geometry
