// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>

#include "osteon/geometry/cleanup.h"
#include "osteon/mesh/triangle_mesh.h"
#include "osteon/rig/skeleton.h"
#include "osteon/skin/weight_rows.h"

namespace osteon::skin {

struct IslandOptions {
  float largest = 0.5f;  // diagonal of an island's bounding box, in parts of the whole mesh's: larger ones bend
  float main = 0.4f;     // share of an island's weight that its joint needs, else it bends,
  float second = 0.6f;   // and the most that any other joint may have, in parts of that
  // The same where no joint lies in the island: artists let one in eight of these bend, and half of the others.
  float main_without = 0.3f;
  float second_without = 0.7f;
};

// Small parts that hang together with nothing else (buttons, eyes, teeth, plates of armour) follow one joint as a whole: that with the most
// weight in them. What a hand holds (a sword) follows the palm, which a hand's joints count for together where none of them lies in the
// part. Parts that are joined to others along edges do not count as islands: `mesh` is clean (geometry::clean), and in the skeleton's
// space. Returns how many islands were made rigid.
std::size_t make_islands_rigid(WeightRows& rows, const TriangleMesh& mesh, const Skeleton& skeleton, const IslandOptions& options = {});

// The same for weights of the mesh that `clean` was made from.
std::size_t make_islands_rigid(SkinWeights& weights, const geometry::CleanMesh& clean, const Skeleton& skeleton,
                               const IslandOptions& options = {});

}  // namespace osteon::skin
