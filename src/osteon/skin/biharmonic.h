// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/geometry/body_lattice.h"
#include "osteon/skin/weight_rows.h"

namespace osteon::skin {

// After bounded biharmonic weights (Jacobson, Baran, Popovic, Sorkine: "Bounded Biharmonic Weights for Real-Time Deformation", SIGGRAPH
// 2011): of each joint the smoothest field (least square of the Laplacian) on the nodes of a coarse lattice that is 1 at the nodes of its
// own bones and 0 at the others'. Differs: the bounds 0..1 are enforced by clamping the solution and not as constraints of a quadratic
// program, on cubes and not tetrahedra. A vertex has the mean of the nodes beneath it; where there are none (parts thinner than a cell),
// its nearest bone's joint; joints whose bones are
// too far to be in `distances` are left out, as the least square swings below and above 0 far away. `coarse` is a lattice of the mesh that
// `distances` are of, with some thousand nodes. Sums 1.
WeightRows biharmonic_weights(const geometry::BodyLattice& coarse, const BoneDistances& distances, std::span<const Bone> bones);

}  // namespace osteon::skin
