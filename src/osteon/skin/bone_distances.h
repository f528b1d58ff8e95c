// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "osteon/geometry/body_lattice.h"
#include "osteon/rig/skeleton.h"

namespace osteon::skin {

struct BoneDistance {
  std::uint32_t bone;
  float distance;  // by way of the body, in the mesh's unit
};

// The bones near every vertex, nearest first (ties: the smaller bone), one row after the other. No row is empty.
struct BoneDistances {
  std::vector<std::uint32_t> offsets{0};  // V + 1
  std::vector<BoneDistance> items;

  std::size_t size() const { return offsets.size() - 1; }
  std::span<const BoneDistance> of(VertexId v) const {
    return std::span(items).subspan(offsets[index(v)], offsets[index(v) + 1] - offsets[index(v)]);
  }
};

struct BoneDistanceOptions {
  float reach = 2.5f;   // a bone this many times as far as the nearest one, and
  float margin = 8.0f;  // so many cells farther, is left out
};

// Geodesic distances of Dionne and de Lasa, "Geodesic Voxel Binding for Production Character Meshes", 2013, sec. 4: for each bone the
// shortest ways (Dijkstra) through the body from the nodes that it passes. Differs from the paper:
// - the body is a BodyLattice: no ways between parts that only touch, and ways over the surface where it is thinner than a cell;
// - nodes that a bone sees get the straight distance, exactly, so that it does not depend on how the lattice lies;
// - bones too far to matter are cut off, so that the work grows with the body and not with body times bones.
// A bone outside the body starts at the faces nearest to it. Pieces of the body that hold no bone are joined to the nearest that do.
// Pre: there are bones.
BoneDistances bone_distances(geometry::BodyLattice& body, std::span<const Bone> bones, const BoneDistanceOptions& options = {});

// Moves vertices away from bones that they lie beyond the ends of: d^2 becomes d^2 + 2 t^2 for a way t past the plane through the end that
// a child's bone starts at, and d^2 + t^2 / 2 before the plane through the start of a bone that has a parent. So what lies around a joint,
// as near to the bone that ends there as to the one that starts (the back of a head), belongs to the latter. Pre: one position for each
// vertex.
void lengthen_past_ends(BoneDistances& distances, const PerVertex<Vec3f>& positions, std::span<const Bone> bones, const Skeleton& skeleton);

// The bones, those of leaf joints made longer: each leads to the middle of what is nearer to it than to any other bone, and on by
// `overshoot` of that.
std::vector<Bone> extended_to_middles(geometry::BodyLattice& body, std::span<const Bone> bones, float overshoot);

}  // namespace osteon::skin
