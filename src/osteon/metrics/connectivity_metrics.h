// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "osteon/base/types.h"
#include "osteon/rig/skeleton.h"

namespace osteon::metrics {

// How well the reference's own joints are connected (RigNet, table 4). NaN where a measure is not defined: a skeleton of one joint has no
// pairs.
struct ConnectivityScores {
  double accuracy;            // share of all pairs of joints that are told right: connected or not, by probability > 0.5
  double precision, recall;   // of the connected pairs among them; precision is NaN where none is said to be connected
  double bones;               // share of the tree's bones that are bones of the reference (which has as many)
  double tree_edit_distance;  // from the tree to the reference; joints are the same by name
  double likeliest_root;      // 1 where the likeliest root is the reference's, else 0
  double root;                // 1 where the tree's root is
};

// `bone_probability` (J,J) symmetric and `root_probability` (J) in the order of the reference's joints; `tree` has the same joints by name,
// in any order. Pre: sizes agree; both skeletons satisfy validate().
ConnectivityScores compare_connectivity(const Matrix& bone_probability, std::span<const float> root_probability, const Skeleton& tree,
                                        const Skeleton& reference);

}  // namespace osteon::metrics
