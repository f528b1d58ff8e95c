// SPDX-License-Identifier: Apache-2.0
#include "osteon/rig/coincident_joints.h"

namespace osteon {
namespace {

// The joint of `merged` that `position`, a child of `parent`, falls on: the parent itself or an earlier child of it.
std::optional<JointId> joint_at(const Skeleton& merged, JointId parent, const Vec3f& position, float distance) {
  if ((merged.rest_positions[parent] - position).norm() < distance) return parent;
  for (JointId j : merged.names.ids())
    if (merged.parents[j] == parent && (merged.rest_positions[j] - position).norm() < distance) return j;
  return std::nullopt;
}

}  // namespace

MergedSkeleton merge_coincident_joints(const Skeleton& skeleton, float distance) {
  MergedSkeleton out;
  for (JointId j : skeleton.names.ids()) {
    const Vec3f& position = skeleton.rest_positions[j];
    std::optional<JointId> parent, same;
    if (skeleton.parents[j]) {
      parent = out.from_original[*skeleton.parents[j]];
      same = joint_at(out.skeleton, *parent, position, distance);
    }
    out.from_original.push_back(same ? *same : out.skeleton.add(skeleton.names[j], parent, position, skeleton.rest_orientations[j]));
  }
  return out;
}

}  // namespace osteon
