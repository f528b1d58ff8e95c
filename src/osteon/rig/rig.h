// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/mesh/triangle_mesh.h"
#include "osteon/rig/skeleton.h"
#include "osteon/rig/skin_weights.h"

namespace osteon {

// An animation-ready character: world space, metres, y up, right-handed. Past the importers everything relies on validate(rig).
struct Rig {
  TriangleMesh mesh;
  Skeleton skeleton;
  SkinWeights weights;  // one row per vertex of mesh
};

void validate(const Rig& rig);

}  // namespace osteon
