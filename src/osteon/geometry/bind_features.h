// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "osteon/base/types.h"
#include "osteon/geometry/rignet_features.h"

// What the binding network (nets/binding.h) reads of a vertex and a bone near it. Nothing here depends on where the character stands or
// which way it faces, so a limb teaches about all limbs.
namespace osteon::geometry {

constexpr int kBindFeatures = 21;
constexpr int kBindBones = 8;  // bones that a vertex can choose from

// A skeleton's bones, parallel arrays; joints are named by their index.
struct BoneList {
  std::vector<Segment> segments;  // normalised frame
  std::vector<int> starts, ends;  // joints; end -1: the zero-length bone at a leaf
};

// One row for each vertex and bone of `nearest` that is not -1, in that order.
struct BindInputs {
  std::vector<float> features;           // (C,kBindFeatures)
  std::vector<std::int32_t> offsets{0};  // (V+1) rows of vertex v are offsets[v] .. offsets[v+1]-1
  std::vector<std::int32_t> bones;       // (C) bone of each row
};

// `normals` of unit length; `distances` (V,k): volumetric_geodesic_distance of the bones in `nearest` (V,k).
BindInputs bind_inputs(std::span<const Vec3f> positions, std::span<const Vec3f> normals, const BoneList& bones, const IndexMatrix& nearest,
                       const Matrix& distances);

}  // namespace osteon::geometry
