// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/skin/weight_rows.h"

namespace osteon::skin {

// Bone heat: Baran and Popovic, "Automatic Rigging and Animation of 3D Characters", SIGGRAPH 2007, sec. 4: w of each joint solves
// (L + H) w = H p, L the surface Laplacian, p = 1 where the joint's bone is the nearest (shared among those within 0.01 %), H = m / d^2, m
// the vertex's area. Differs: d is the distance by way of the body and never infinite, so that islands, open surfaces and bones outside of
// the body get weights too. Sums 1.
WeightRows heat_weights(const TriangleMesh& mesh, const BoneDistances& distances, std::span<const Bone> bones);

}  // namespace osteon::skin
