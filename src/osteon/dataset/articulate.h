// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "osteon/base/random.h"
#include "osteon/dataset/articulation.h"
#include "osteon/dataset/prepared.h"

namespace osteon::dataset {

// How a character is changed through its own rig, so that a few bodies stand for many.
struct ArticulateOptions {
  float probability = 0.8f;    // of changing a character at all
  float symmetric = 0.6f;      // of changing both sides alike, where there are two sides
  float largest_bend = 0.35f;  // the joints' angles have a standard deviation between 0 and this, radians; short bones bend less
  float proportion = 0.15f;    // standard deviation of the logarithm of a part's size, against its parent's
  float from_motion = 0.0f;  // share of those changed that stand in one of their own poses, where they have some, in place of random bends
};

// For each joint the joint that is its mirror image (itself on the plane); empty where there is none, and for all without a plane.
PerJoint<std::optional<JointId>> mirror_partners(const Skeleton& skeleton, const std::optional<Plane>& symmetry);

// Random bends and proportions. Sizes are not passed on whole (a part keeps 0.7 of the logarithm of its parent's), so a big head has no
// giant's hat; children go where their parent's part carries them. With `symmetry`, joints with a mirror image move like it.
Articulation random_articulation(const Skeleton& skeleton, const std::optional<Plane>& symmetry, const ArticulateOptions& options,
                                 Random& random);

// A pose with proportions on top: `sizes` has no turns, as random_articulation() makes it without bends. Bones stay where they meet.
Articulation with_sizes(const Articulation& pose, const Articulation& sizes, const Skeleton& skeleton);

// The character skinned that way (linear blend), normalised again, without poses: these were of its old shape. What follows from the shape
// is left as it was: derive_from_shape().
PreparedCharacter articulated(const PreparedCharacter& character, const Articulation& articulation);

}  // namespace osteon::dataset
