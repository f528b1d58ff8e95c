// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "osteon/geometry/voxel_grid.h"
#include "osteon/mesh/triangle_mesh.h"

namespace osteon::geometry {

// How far each vertex is from each bone by way of the body, (V,B), in the mesh's unit (normalised: longest side 1). After the approximation
// in RigNet (facts 7.2) of the distance in Dionne and de Lasa, "Geodesic Voxel Binding for Production Character Meshes", 2013:
// - A vertex that sees the nearest point of the bone through the body gets the Euclidean distance. It sees it if that point is inside the
// grid
//   and the line passes no voxel Outside and, before it arrives at the vertex from within, leaves at most as many parts as it has entered
//   (a sleeve that begins inside the body, an eye in its socket).
// - So do the corners of the faces nearest to the bone, by way of the nearest point: a bone outside the body has these alone.
// - All other vertices: the shortest way to one of them over surface_graph(mesh).
// - Where no way leads (a piece that floats): 1 + Euclidean distance, so that every bone within reach comes first.
// Differs from the reference, where a line that meets nothing counts as sight (leaks through holes) and where overlapping parts hide
// vertices. Pre: grid = voxelize(mesh).
Matrix volumetric_geodesic_distance(const TriangleMesh& mesh, const VoxelGrid& grid, std::span<const Segment> bones);

}  // namespace osteon::geometry
