// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>

#include "osteon/base/indexed.h"
#include "osteon/base/types.h"

namespace osteon {

enum class VertexId : std::uint32_t {};
enum class FaceId : std::uint32_t {};
template <class T>
using PerVertex = Indexed<VertexId, T>;
template <class T>
using PerFace = Indexed<FaceId, T>;
using Triangle = std::array<VertexId, 3>;  // counter-clockwise seen from outside

// A triangle soup with shared vertices. Non-manifold edges, open borders and many components are normal.
// Invariants (see validate): at least one vertex; all coordinates finite; every index in range.
struct TriangleMesh {
  PerVertex<Vec3f> positions;
  PerFace<Triangle> faces;
};

// Throws Error naming the first vertex or face that breaks an invariant.
void validate(const TriangleMesh& mesh);

// Axis-aligned bounding box. Pre: the mesh has vertices.
Eigen::AlignedBox3f bounds(const TriangleMesh& mesh);

// Twice the area of a face along its normal (right-hand rule); zero for a degenerate face.
Vec3f area_vector(const TriangleMesh& mesh, FaceId face);
double surface_area(const TriangleMesh& mesh);

// Unit vertex normals, weighted by face area; (0,1,0) where no face with area touches the vertex.
PerVertex<Vec3f> vertex_normals(const TriangleMesh& mesh);

// Component of each vertex, numbered 0.. in order of the first vertex; two vertices are in one component when a chain of faces joins them.
struct Components {
  PerVertex<std::uint32_t> of;
  std::uint32_t count = 0;
};
Components connected_components(const TriangleMesh& mesh);

}  // namespace osteon
