// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "osteon/pipelines/skeleton_tree.h"

namespace osteon::pipelines {

// A skeleton whose joints come, go and move before it is one.
struct SkeletonDraft {
  JointSet joints;
  JointTree tree;
  std::vector<std::optional<std::size_t>> from;  // (J) the number of the joint that the networks found; none: geometry did
  std::vector<std::optional<HandPart>> part;     // (J) what it is of a hand

  // As the networks found it.
  static SkeletonDraft of(JointSet joints, JointTree tree) {
    SkeletonDraft out{std::move(joints), std::move(tree), {}, {}};
    for (std::size_t j = 0; j < out.joints.size(); ++j) out.from.emplace_back(j);
    out.part.resize(out.joints.size());
    return out;
  }
};

}  // namespace osteon::pipelines
