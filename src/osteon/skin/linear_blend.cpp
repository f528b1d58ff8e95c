// SPDX-License-Identifier: Apache-2.0
#include "osteon/skin/linear_blend.h"

#include <cassert>

#include "osteon/base/parallel.h"

namespace osteon::skin {
namespace {

constexpr std::size_t kVerticesPerTask = 2048;

}  // namespace

PerVertex<Vec3f> skin(const PerVertex<Vec3f>& positions, const SkinWeights& weights, const PerJoint<Transform>& transforms) {
  assert(weights.size() == positions.size());
  PerVertex<Vec3f> out(positions.size());
  parallel_for(positions.size(), kVerticesPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto v = static_cast<VertexId>(i);
      for (const auto& [joint, weight] : weights[v]) out[v] += weight * (transforms[joint] * positions[v]);
    }
  });
  return out;
}

PerVertex<Vec3f> skin(const Rig& rig, const Pose& pose) {
  return skin(rig.mesh.positions, rig.weights, skinning_transforms(rig.skeleton, pose));
}

}  // namespace osteon::skin
