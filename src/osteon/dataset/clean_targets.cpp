// SPDX-License-Identifier: Apache-2.0
#include "osteon/dataset/clean_targets.h"

#include <vector>

#include "osteon/base/parallel.h"
#include "osteon/geometry/bvh.h"

namespace osteon::dataset {
namespace {

std::vector<Influence> blend(const geometry::ClosestPoint& at, const TriangleMesh& mesh, const SkinWeights& weights,
                             const PerJoint<JointId>& to_joint) {
  std::vector<Influence> row;
  for (int corner = 0; corner < 3; ++corner)
    for (const Influence& i : weights[mesh.faces[at.face][static_cast<std::size_t>(corner)]])
      row.push_back({to_joint[i.joint], i.weight * at.barycentric[corner]});
  return row;
}

}  // namespace

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
