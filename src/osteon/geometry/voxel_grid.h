// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "osteon/mesh/triangle_mesh.h"

namespace osteon::geometry {

enum class Voxel : std::uint8_t { Outside, Surface, Interior };

// The solid that a mesh encloses, as cubes. Cell (i,j,k) spans origin + cell * [i,i+1] x [j,j+1] x [k,k+1].
struct VoxelGrid {
  Vec3f origin = Vec3f::Zero();
  float cell = 1.0f;  // edge length, in the mesh's unit
  Eigen::Array3i size = Eigen::Array3i::Zero();
  std::vector<Voxel> voxels;  // size.prod(); (i,j,k) at (i * size.y + j) * size.z + k

  std::size_t index(const Eigen::Array3i& at) const {
    return (static_cast<std::size_t>(at.x()) * static_cast<std::size_t>(size.y()) + static_cast<std::size_t>(at.y())) *
               static_cast<std::size_t>(size.z()) +
           static_cast<std::size_t>(at.z());
  }
  Vec3f center(const Eigen::Array3i& at) const { return origin + cell * (at.cast<float>() + 0.5f).matrix(); }
  // The voxel around p; Outside beyond the grid.
  Voxel at(const Vec3f& p) const;
  // In the solid or in a voxel that its surface touches.
  bool inside(const Vec3f& p) const { return at(p) != Voxel::Outside; }
};

// `resolution` cells along the longest side of the bounding box, and a margin of one cell all round. A voxel is
// - Surface if a face touches it (exact test: Schwarz and Seidel, "Fast parallel surface and solid voxelization on GPUs", 2010, sec. 3);
// - Interior if most of the six views along the axes see its centre inside, or if no way leads out of it.
// A view counts the faces that it enters and leaves through; six of them estimate the generalised winding number (Jacobson et al.,
// "Robust inside-outside segmentation", 2013), clamped to [0,1] each. So meshes may be open (trousers, hair caps), in pieces, overlapping
// or non-manifold; parity, as in the reference's binvox, flips at every overlap and leaks at every hole.
VoxelGrid voxelize(const TriangleMesh& mesh, int resolution = 88);

// RigNet's samples of a bone (facts 6.1): max(1, round(length / step)) points, evenly spaced, the end a excluded, b included.
int sample_count(const Segment& segment, float step = 0.01f);
int samples_outside(const VoxelGrid& grid, const Segment& segment, float step = 0.01f);
float inside_fraction(const VoxelGrid& grid, const Segment& segment, float step = 0.01f);  // of the samples, 0..1

}  // namespace osteon::geometry
