// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "osteon/mesh/triangle_mesh.h"

namespace osteon::geometry {

// The inside of a body as points, the centres of cubes, and the straight steps between neighbouring ones that stay inside. Unlike voxels,
// two parts that touch do not run into one another, however close they are: no step leads out through one surface and in through the next.
// Only cubes with their centre inside are nodes: a part thinner than a cube may have none.
struct SolidLattice {
  static constexpr std::uint32_t kNone = UINT32_MAX;

  Vec3f origin = Vec3f::Zero();  // cell (i,j,k) spans origin + cell * [i,i+1] x [j,j+1] x [k,k+1]
  float cell = 1.0f;             // edge length, in the mesh's unit
  Eigen::Array3i size = Eigen::Array3i::Zero();
  std::vector<std::uint32_t> node_of;  // size.prod(); of cell (i,j,k) at (i * size.y + j) * size.z + k: its node, or kNone
  std::vector<std::uint32_t> cell_of;  // of each node, ascending
  std::vector<Vec3f> positions;        // of each node: the cell's centre
  std::vector<std::uint32_t> steps;    // of each node: bit k is set where step k of lattice_steps() leads to a node

  std::size_t nodes() const { return cell_of.size(); }
  std::uint32_t index(const Eigen::Array3i& at) const {
    return static_cast<std::uint32_t>((at.x() * size.y() + at.y()) * size.z() + at.z());
  }
  // Of a point beyond the grid, however far, one in that direction beyond the grid.
  Eigen::Array3i cell_at(const Vec3f& p) const {
    return ((p - origin) / cell).array().floor().max(-1.0f).min(size.cast<float>()).cast<int>();
  }
  // The node of the cell; kNone beyond the grid.
  std::uint32_t node_at(const Eigen::Array3i& at) const { return (at >= 0).all() && (at < size).all() ? node_of[index(at)] : kNone; }
};

// The 26 steps to neighbouring cells: step k and step 25 - k are opposite.
const std::array<Eigen::Array3i, 26>& lattice_steps();

// `resolution` cells along the longest side of the bounding box, and a margin of one cell all round; fewer (but 64) where more than about
// `most_nodes` cells would be inside. Which centres are inside is decided as in voxelize() by most of the six views along the axes, so that
// meshes may be open, in pieces, overlapping or non-manifold; components whose faces look inwards are turned first.
// - A step along an axis is blocked where the line leaves all parts before it enters another one, at the same point too.
// - Where one component overlaps itself (thigh and thigh) is no inside, so that nothing leaks through it.
// - A diagonal step is allowed where some way along the axes is.
// Pre: validate(mesh) holds; resolution > 0.
SolidLattice solid_lattice(const TriangleMesh& mesh, int resolution, std::size_t most_nodes = SIZE_MAX);

}  // namespace osteon::geometry
