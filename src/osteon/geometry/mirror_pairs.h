// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "osteon/mesh/triangle_mesh.h"

namespace osteon::geometry {

// A mesh that is its own mirror image vertex by vertex.
struct MirrorPairs {
  Plane plane;                  // fitted to the pairs; exactly x = 0 where that fits
  PerVertex<VertexId> partner;  // partner[partner[v]] == v; a vertex on the plane is its own
};

// Empty unless every vertex has a partner within 1e-4 of its mirror image; of several the one with the mirrored normal (where parts
// touch). `near` (geometry/symmetry.h) may be off by some thousandths: the plane is fitted to pairs in rounds of shrinking reach, in
// each by the eigenvector n with the least sum over the pairs of n.(p - m) n.(q - m), m the middle of all, which is the least squares of
// the images' distances. Empty, too, where vertices lie so close together that to compare them would take long. Pre: longest side 1, and
// the bounding box around x = 0.
std::optional<MirrorPairs> mirror_pairs(const TriangleMesh& mesh, const Plane& near);

}  // namespace osteon::geometry
