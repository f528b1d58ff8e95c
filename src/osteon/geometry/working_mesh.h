// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "osteon/geometry/cleanup.h"
#include "osteon/mesh/triangle_mesh.h"

namespace osteon::geometry {

// The frame of the networks: longest side of the bounding box 1, feet on y = 0, centred on x and z (RigNet's quick_start.py,
// normalize_obj).
struct Normalization {
  float scale;  // 1 / longest side
  Vec3f pivot;  // mid x, min y, mid z, in the original's unit

  Vec3f apply(const Vec3f& p) const { return (p - pivot) * scale; }
  Vec3f undo(const Vec3f& p) const { return p / scale + pivot; }
};

// Throws Error when the mesh has no extent at all.
Normalization normalization_of(const TriangleMesh& mesh);

struct WorkingMeshOptions {            // min <= target <= max
  std::size_t target_vertices = 1200;  // larger meshes are reduced to about this many, and 4 more for every separate piece but one
  std::size_t min_vertices = 1000;     // smaller ones are subdivided up to it (paper: 1 to 5 thousand)
  std::size_t max_vertices = 5000;     // of many hundred pieces the smallest are left out, so that there are not more
};

// What the networks see instead of the original.
struct WorkingMesh {
  TriangleMesh mesh;  // normalised
  Normalization normalization;
  CleanMesh clean;                                // of the original, in its unit; neighbours face alike, no body inside out
  PerVertex<std::optional<VertexId>> from_clean;  // clean vertex -> the vertex of `mesh` that stands for it; none: its piece was left out
};

// Cleans, reduces or subdivides, and normalises. Depends on the shape only, not on the order of vertices and faces.
// Throws Error when the mesh has no face with area. Pre: validate(original) holds.
WorkingMesh make_working_mesh(const TriangleMesh& original, const WorkingMeshOptions& options = {});

// A point on the working mesh: what belongs to its vertices is interpolated with these weights.
struct SurfacePoint {
  std::array<VertexId, 3> vertices;  // of the working mesh
  std::array<float, 3> weights;      // >= 0, sum 1
};

// For every vertex of the original the point of the working mesh that it lies on (or nearest to). Points are looked for along the surface
// from where the reduction left the vertex, so they never jump to another piece nor across a thin gap (finger to finger, arm to body).
// Vertices at one position of one surface get the same point: no cracks along texture seams.
PerVertex<SurfacePoint> carry_back(const WorkingMesh& working);

}  // namespace osteon::geometry
