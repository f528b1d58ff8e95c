// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/mesh/triangle_mesh.h"
#include "osteon/pipelines/skeleton_draft.h"

namespace osteon::pipelines {

// The share of the hands' joints that are right, as with joint_confidence: 57 of 64 on `val`, 1,248 of 1,434 of training characters.
constexpr float kHandConfidence = 0.88f;

// Looks for a hand with fingers (hand_shape.h) beyond every joint that ends a limb beside the plane and off the ground, and puts its joints
// in the place of those of its limb that were found within it: votes for what is so thin melt into one. The wrist hangs on what the first
// of these hung on, or on the nearest joint of the limb where there were none; fingers hang on the wrist.
// Of mirror images both hands get the mean, or the one that is seen as far as its wrist, or has more fingers; if only one side has a hand,
// so does the other where `is_image` says that the surface is its own mirror image, else that hand has no partner. `mesh`: before it was
// reduced, in the normalised frame. Pre: as of connect(); `tree` is of `joints`.
SkeletonDraft with_hands(const JointSet& joints, const JointTree& tree, const TriangleMesh& mesh, bool is_image);

}  // namespace osteon::pipelines
