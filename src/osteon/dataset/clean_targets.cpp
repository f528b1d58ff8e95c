// SPDX-License-Identifier: Apache-2.0
#include "osteon/dataset/clean_targets.h"

#include <optional>
#include <vector>

#include "osteon/base/parallel.h"
#include "osteon/geometry/bvh.h"

namespace osteon::dataset {
namespace {

// The joint of `merged` that `position`, a child of `parent`, falls on: the parent itself or an earlier child of it.
std::optional<JointId> joint_at(const Skeleton& merged, JointId parent, const Vec3f& position, float distance) {
  if ((merged.rest_positions[parent] - position).norm() < distance) return parent;
  for (JointId j : merged.names.ids())
    if (merged.parents[j] == parent && (merged.rest_positions[j] - position).norm() < distance) return j;
  return std::nullopt;
}

std::vector<Influence> blend(const geometry::ClosestPoint& at, const TriangleMesh& mesh, const SkinWeights& weights,
                             const PerJoint<JointId>& to_joint) {
  std::vector<Influence> row;
  for (int corner = 0; corner < 3; ++corner)
    for (const Influence& i : weights[mesh.faces[at.face][static_cast<std::size_t>(corner)]])
      row.push_back({to_joint[i.joint], i.weight * at.barycentric[corner]});
  return row;
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

SkinWeights weights_at(std::span<const Vec3f> points, const TriangleMesh& original, const SkinWeights& weights,
                       const PerJoint<JointId>& to_joint) {
  const geometry::Bvh surface(original);
  std::vector<std::vector<Influence>> rows(points.size());
  parallel_for(points.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) rows[v] = blend(surface.closest_point(points[v]), original, weights, to_joint);
  });
  SkinWeights out;
  for (const auto& row : rows) out.append(row);
  return out;
}

}  // namespace osteon::dataset
