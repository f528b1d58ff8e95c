// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "osteon/geometry/body_lattice.h"
#include "osteon/rig/skeleton.h"

namespace osteon::skin {

// The axis of the joints' own frames along which the bones of a skeleton lie. Every joint with one child votes for the axis that points at
// it (within 14 degrees); +y, as in Blender and in our own files, has two votes from the start. Empty where no axis gets 60 % of them, and
// where all joints have the same axes (VRM), which then tell nothing.
std::optional<Vec3f> bone_axis(const Skeleton& skeleton);

// The bones that skin is bound to. Where the skeleton has a bone axis it says more of what the artist meant than the tree of joints does:
// - a leaf joint's bone goes on along the axis as far as the body does, and `overshoot` beyond: hands without fingers, heads, toes;
// - where the axis points at one of several children (hips to spine), the bones to the others (hips to thighs) are a tenth shorter.
// - leaf joints whose name ends with "end" or "nub" have no bone: they only say where the one before them ends.
// Without an axis a leaf's bone leads to the middle of what is nearer to it than to any other bone, and on by half of that.
std::vector<Bone> binding_bones(const Skeleton& skeleton, geometry::BodyLattice& body, float overshoot = 0.3f);

}  // namespace osteon::skin
