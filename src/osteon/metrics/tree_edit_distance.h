// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "osteon/rig/skeleton.h"

namespace osteon::metrics {

// How many joints must be deleted, inserted or replaced (1 each) to turn the tree of `a` into the tree of `b`. `partner[j]` is the joint of
// `b` that counts as the same as joint j of `a`: turning j into it is free.
// RigNet (sec. 5.2, table 4) names the measure but not its details. Our reading: rooted trees whose children have no order, and unit costs,
// by the constrained edit distance, in which separate subtrees stay separate: Zhang, "A constrained edit distance between unordered labeled
// trees", Algorithmica 15, 1996. The unconstrained distance of unordered trees is NP-hard; this one is a metric never below it.
int tree_edit_distance(const Skeleton& a, const Skeleton& b, const PerJoint<std::optional<JointId>>& partner);

}  // namespace osteon::metrics
