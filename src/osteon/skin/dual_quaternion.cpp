// SPDX-License-Identifier: Apache-2.0
#include "osteon/skin/dual_quaternion.h"

#include <cassert>

#include "osteon/base/parallel.h"

namespace osteon::skin {
namespace {

constexpr std::size_t kVerticesPerTask = 2048;

struct DualQuaternion {
  Eigen::Vector4f real = Eigen::Vector4f::Zero(), dual = Eigen::Vector4f::Zero();  // x, y, z, w
};

DualQuaternion dual_quaternion(const Transform& transform) {
  const Quatf q = Quatf(transform.linear()).normalized();
  const Vec3f t = transform.translation();
  const Quatf dual = Quatf(0.0f, t.x(), t.y(), t.z()) * q;
  return {q.coeffs(), 0.5f * dual.coeffs()};
}

Vec3f moved(const Vec3f& p, const DualQuaternion& sum) {
  const float length = sum.real.norm();
  const Quatf q(Eigen::Vector4f(sum.real / length));
  const Quatf d(Eigen::Vector4f(sum.dual / length));
  return q * p + 2.0f * (d * q.conjugate()).vec();
}

}  // namespace

PerVertex<Vec3f> skin_dual_quaternion(const PerVertex<Vec3f>& positions, const SkinWeights& weights,
                                      const PerJoint<Transform>& transforms) {
  assert(weights.size() == positions.size());
  PerJoint<DualQuaternion> joints;
  for (const Transform& transform : transforms) joints.push_back(dual_quaternion(transform));
  PerVertex<Vec3f> out(positions.size());
  parallel_for(positions.size(), kVerticesPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto v = static_cast<VertexId>(i);
      const Eigen::Vector4f& first = joints[weights[v].front().joint].real;
      DualQuaternion sum;
      for (const auto& [joint, weight] : weights[v]) {
        const float signed_weight = joints[joint].real.dot(first) < 0.0f ? -weight : weight;
        sum.real += signed_weight * joints[joint].real;
        sum.dual += signed_weight * joints[joint].dual;
      }
      out[v] = moved(positions[v], sum);
    }
  });
  return out;
}

PerVertex<Vec3f> skin_dual_quaternion(const Rig& rig, const Pose& pose) {
  return skin_dual_quaternion(rig.mesh.positions, rig.weights, skinning_transforms(rig.skeleton, pose));
}

}  // namespace osteon::skin
