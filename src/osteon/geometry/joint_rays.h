// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "osteon/geometry/bvh.h"
#include "osteon/mesh/triangle_mesh.h"

// Rays from a joint to the surface, perpendicular to the bones that meet there: how thick the body is around the joint, and which vertices
// lie around it (RigNet sec. 4.1 and 6.1; facts 5.2). A skeleton is given as joint positions and the index of each joint's parent (-1:
// none), both (J).
namespace osteon::geometry {

constexpr int kJointRays = 14;  // a bone, in its perpendicular plane, at equal angles

struct SurfaceHits {
  std::vector<Vec3f> points;
  std::vector<float> distances;  // from the joint, parallel to points
};

// Where rays from `joint` first meet the surface, perpendicular to `axis` (unit). If none does: the corners of the face nearest to the
// joint. Pre: the mesh has faces.
SurfaceHits perpendicular_hits(const TriangleMesh& mesh, const Bvh& surface, const Vec3f& joint, const Vec3f& axis);

// Mean ray length of each joint over all its bones, (J), in the mesh's unit: about half the local diameter. A prediction within it counts
// as found (facts/metrics.md: the reading of RigNet's "half the shape diameter" that its author confirmed). A joint without a bone of any
// length is measured in the horizontal plane. Pre: the mesh has faces.
std::vector<float> joint_tolerances(const TriangleMesh& mesh, std::span<const Vec3f> joints, std::span<const int> parents);

// RigNet's attention target, (V), 0 or 1: vertices within 0.02 of where a joint's rays hit, hits at least twice as far as the bone's 20th
// percentile left out; of a joint with fewer than 6 such vertices the 6 nearest. Pre: the mesh is normalised (longest side 1) and has
// faces.
std::vector<std::uint8_t> attention_labels(const TriangleMesh& mesh, std::span<const Vec3f> joints, std::span<const int> parents);

}  // namespace osteon::geometry
