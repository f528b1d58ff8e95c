// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "osteon/base/types.h"
#include "osteon/rig/skeleton.h"

namespace osteon::skin {

struct DistanceWeightsOptions {
  float falloff = 4.0f;  // power of 1 / distance
  float margin = 0.01f;  // added to every distance, in its unit: bounds the weight of a vertex on the bone
};

// Weights from distances alone, (V,J), rows sum to 1: each bone gives (D + margin)^-falloff to the joint it starts at. After geodesic voxel
// binding (Dionne and de Lasa, "Geodesic Voxel Binding for Production Character Meshes", 2013) with their squared kernel simplified to one
// power. The fallback where no trained network is trusted, and a yardstick for those. `distances` (V,B) as volumetric_geodesic_distance
// gives them, for bones(skeleton) with `joints` joints. Of several bones of one joint the nearest counts, so that a fan of bones has no
// more pull than one.
Matrix distance_weights(const Matrix& distances, std::span<const Bone> bones, std::size_t joints,
                        const DistanceWeightsOptions& options = {});

}  // namespace osteon::skin
