// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "osteon/geometry/neighbourhoods.h"
#include "osteon/rig/skin_weights.h"
#include "osteon/skin/bone_distances.h"

// Weights while they are made, for skeletons of any size: only what is not 0 is stored, so that nothing costs vertices times joints.
namespace osteon::skin {

// Influences of every vertex, in the order of the joints, no joint twice, weights > 0. Sums are 1 within rounding where a function says so.
using WeightRow = std::vector<Influence>;
using WeightRows = PerVertex<WeightRow>;

struct FalloffOptions {
  float power = 10.0f;    // of 1 / distance
  float margin = 0.005f;  // added to every distance; longest side 1
};

// Each joint's share by the distance of its nearest bone: (d + margin)^-power, sums 1. After Dionne and de Lasa 2013, sec. 5, with their
// kernel
// ((1 - a) d + a d^2)^-2 replaced by one power, which does not depend on the unit. `size`: of the mesh, its longest side.
WeightRows falloff_weights(const BoneDistances& distances, std::span<const Bone> bones, float size, const FalloffOptions& options = {});

// Each vertex follows the joint of its nearest bone alone.
WeightRows nearest_weights(const BoneDistances& distances, std::span<const Bone> bones);

// Sorts by joint and adds up what belongs to one.
void merge(WeightRow& row);

// Makes the sum 1. Pre: the row is not empty, weights > 0.
void normalize(WeightRow& row);

// Each row becomes the mean of its own and the mean of its neighbours' rows, so many times. Sums stay.
WeightRows smoothed(WeightRows rows, const geometry::Neighbourhoods& one_ring, int times);

// Drops what is below `share` of a row's largest weight, and all but the `most` largest (ties: the smaller joint stays); sums 1.
void prune(WeightRows& rows, float share, std::size_t most);

// Pre: no row is empty.
SkinWeights to_skin_weights(const WeightRows& rows, const PerVertex<VertexId>& from_original);

}  // namespace osteon::skin
