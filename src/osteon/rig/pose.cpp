// SPDX-License-Identifier: Apache-2.0
#include "osteon/rig/pose.h"

namespace osteon {

PerJoint<Transform> skinning_transforms(const Skeleton& skeleton, const Pose& pose) {
  PerJoint<Transform> out(skeleton.size(), Transform::Identity());
  for (JointId j : skeleton.names.ids()) {
    const Vec3f& p = skeleton.rest_positions[j];
    const Transform parent =
        skeleton.parents[j] ? out[*skeleton.parents[j]] : Transform(Eigen::Translation3f(pose.root_translation));
    out[j] = parent * Eigen::Translation3f(p) * pose.rotations[j] * Eigen::Translation3f(-p);
  }
  return out;
}

PerJoint<Vec3f> posed_positions(const Skeleton& skeleton, const Pose& pose) {
  const auto transforms = skinning_transforms(skeleton, pose);
  PerJoint<Vec3f> out(skeleton.size());
  for (JointId j : skeleton.names.ids()) out[j] = transforms[j] * skeleton.rest_positions[j];
  return out;
}

}  // namespace osteon
