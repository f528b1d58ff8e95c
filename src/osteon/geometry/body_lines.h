// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <optional>

#include "osteon/geometry/bvh.h"
#include "osteon/geometry/voxel_grid.h"
#include "osteon/mesh/triangle_mesh.h"

namespace osteon::geometry {

// Straight lines inside the body that a mesh encloses. The mesh may be open and its parts may overlap: a line is in as many parts as it has
// entered and not yet left, and outside when it is in none, or in a voxel Outside (which is how it gets out through a hole).
// Keeps references: mesh and grid must live as long.
class BodyLines {
 public:
  BodyLines(const TriangleMesh& mesh, const VoxelGrid& grid);  // pre: grid = voxelize(mesh)

  // Voxels Interior are, voxels Outside are not; in those that the surface touches the generalised winding number decides (Jacobson et al.
  // 2013).
  bool is_inside(const Vec3f& p) const;

  // Whether the line from a point inside to a vertex stays inside and meets the vertex from within.
  bool sees(const Vec3f& from, VertexId v) const;

  // The face through which a line leaves that starts inwards from a vertex; none when the direction (unit) does not point inwards of all
  // faces around the vertex, or when the line gets out through a hole.
  std::optional<RayHit> opposite(VertexId v, const Vec3f& direction) const;

  const Bvh& surface() const { return surface_; }
  // Unit normal, or zero where the faces around the vertex cancel out or there are none.
  const Vec3f& normal(VertexId v) const { return normals_[v]; }

 private:
  std::optional<RayHit> way_out(const Vec3f& from, const Vec3f& direction, float length, VertexId ignored) const;
  bool passes_outside(const Vec3f& from, const Vec3f& line) const;
  bool points_inwards(VertexId v, const Vec3f& direction) const;

  const TriangleMesh& mesh_;
  const VoxelGrid& grid_;
  Bvh surface_;
  PerVertex<Vec3f> normals_;
  PerVertex<std::vector<Vec3f>> normals_around_;  // of the faces with area, of unit length
};

}  // namespace osteon::geometry
