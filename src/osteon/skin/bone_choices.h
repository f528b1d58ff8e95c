// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "osteon/geometry/bind_features.h"
#include "osteon/geometry/rignet_features.h"
#include "osteon/rig/skeleton.h"

namespace osteon::skin {

struct BoneChoiceOptions {
  int resolution = 64;    // of the lattice, along the longest side
  std::size_t most = 10;  // joints that a vertex can choose from
};

// The joints that each vertex may follow, nearest first, each with the nearest of its bones; what NeuroSkinning's successor decides
// between.
struct BoneChoices {
  geometry::BoneList bones;       // skin::binding_bones of the skeleton
  geometry::IndexMatrix nearest;  // (V,most) bone, -1: no more; the first is always there
  Matrix distances;               // (V,most) skin::bone_distances, past the ends lengthened
  Matrix shares;                  // (V,most) of the joint by geodesic voxel binding: small islands rigid, smoothed once over the one-ring
};

// Pre: validate(mesh) holds, mesh has faces and is clean (geometry/cleanup.h); the skeleton is in its space.
BoneChoices bone_choices(const TriangleMesh& mesh, const Skeleton& skeleton, const BoneChoiceOptions& options = {});

}  // namespace osteon::skin
