// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "osteon/geometry/voxel_grid.h"
#include "osteon/mesh/triangle_mesh.h"

namespace osteon::geometry {

// Which distances are asked for: of each vertex those to the `count` nearest joints, to each by its nearest bone.
struct NearestJoints {
  std::span<const int> joint_of;  // (B) where each bone starts
  int count;                      // > 0
};

// How far each vertex is from each bone by way of the body, (V,B), in the mesh's unit (normalised: longest side 1). After the approximation
// in RigNet (facts 7.2) of the distance in Dionne and de Lasa, "Geodesic Voxel Binding for Production Character Meshes", 2013:
// - A vertex that sees the nearest point of the bone along a line in the body (BodyLines) gets the Euclidean distance.
// - So do the corners of the faces nearest to the bone, by way of the nearest point: a bone outside the body has these alone.
// - All other vertices: the shortest way from those in body_graph(mesh), which is connected, so that every distance is finite.
// Differs from the reference, where a line that meets nothing counts as sight (leaks through holes), overlapping parts hide vertices, ways
// lead over the surface only and pieces that float are 8 away from everything. Pre: grid = voxelize(mesh); the mesh has faces.
Matrix volumetric_geodesic_distance(const TriangleMesh& mesh, const VoxelGrid& grid, std::span<const Segment> bones);

// The same numbers where they are asked for, infinity elsewhere (joints as far as the last of the wanted are kept): half of the work and
// less.
Matrix volumetric_geodesic_distance(const TriangleMesh& mesh, const VoxelGrid& grid, std::span<const Segment> bones,
                                    const NearestJoints& wanted);

// The same in a straight line, through whatever lies between: to see what the way by the body is good for.
Matrix straight_distance(const TriangleMesh& mesh, std::span<const Segment> bones);

}  // namespace osteon::geometry
