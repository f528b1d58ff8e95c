// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <vector>

#include "osteon/mesh/triangle_mesh.h"

namespace osteon::geometry {

// What a vertex knows of the body beneath it, by rays inwards. Joints lie in the middle of the body: from here it is not far to one.
struct VoteFeatures {
  PerVertex<Vec3f> normals;      // unit length, outwards
  PerVertex<Vec3f> to_middle;    // from the vertex: mean of the middles of the rays; zero where none leaves the body again
  PerVertex<float> thicknesses;  // median length of the rays: local shape diameter; 0 likewise
};

// Seven rays from each vertex, along the inward normal and 40 degrees around it, to where they leave the body: meet a face from behind.
// Lengths in the mesh's unit. After Shapira, Shamir, Cohen-Or. Consistent Mesh Partitioning and Skeletonisation Using the Shape Diameter
// Function. Visual Computer 24(4), 2008, section 3. Differs: fewer rays, and no outliers are left out, as the middle is wanted too.
// Pre: the mesh is normalised (longest side 1).
VoteFeatures vote_features(const TriangleMesh& mesh);

// As the network reads them, (V,26): normal, way to the middle, thickness, log(joints) - 3 with `joints` how many the rig shall have, and
// the sine and cosine of 2, 4 and 8 pi times each coordinate of the middle (positions[v] + way): in plain coordinates a few layers see only
// broad trends of where the joints are (Tancik and others. Fourier Features Let Networks Learn High Frequency Functions in Low Dimensional
// Domains. NeurIPS 2020).
constexpr int kVoteFeatures = 26;
std::vector<float> vote_rows(std::span<const Vec3f> positions, const VoteFeatures& features, float joints);

}  // namespace osteon::geometry
