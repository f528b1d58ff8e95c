// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>

#include "osteon/rig/rig.h"
#include "osteon/skin/deformation_score.h"

namespace osteon::pipelines {

// What can be said of skin weights without a reference.
struct SkinQuality {
  std::size_t unweighted = 0;       // vertices without weight: always 0 past the importers
  double largest_sum_error = 0.0;   // |sum of a row - 1|, the largest
  double coverage = 0.0;            // share of the vertices with a bone within 0.2 (longest side 1) by way of the body
  double leak = 0.0;                // share of all weight on bones more than 2.5 times as far, by way of the body, as a vertex's nearest
  double roughness = 0.0;           // mean over the edges of half the L1 difference between their ends' weights, 0..1
  std::optional<double> asymmetry;  // mean half L1 difference between mirrored vertices, 0..1; none unless mesh and skeleton are symmetric
  skin::DeformationScore deformation;
};

// Pre: validate(rig) holds; the mesh has faces.
SkinQuality skin_quality(const Rig& rig);

// The joints of a symmetric character changed for their mirror partners, and the vertices of the clean mesh. Empty unless every vertex and
// every joint has a partner.
struct MirrorMap {
  PerVertex<VertexId> from_original;   // -> clean vertex
  PerVertex<VertexId> vertex_partner;  // of clean vertices
  PerJoint<JointId> joint_partner;
};
std::optional<MirrorMap> mirror_map(const TriangleMesh& mesh, const Skeleton& skeleton);

}  // namespace osteon::pipelines
