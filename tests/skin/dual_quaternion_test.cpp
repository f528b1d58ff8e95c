// SPDX-License-Identifier: Apache-2.0
#include "osteon/skin/dual_quaternion.h"

#include <numbers>

#include "osteon/mesh/shapes.h"
#include "osteon/skin/deformation_score.h"
#include "osteon/skin/linear_blend.h"
#include "support/expect.h"

namespace osteon::skin {
namespace {

// A capsule along y with a joint at each third; the weights go over from one to the other evenly.
Rig capsule() {
  Rig rig{shapes::capsule(0.1f, 1.0f), {}, {}};
  const JointId a = rig.skeleton.add("a", std::nullopt, {0, 0, 0});
  const JointId b = rig.skeleton.add("b", a, {0, 0.5f, 0});
  for (const Vec3f& p : rig.mesh.positions) {
    const float upper = std::clamp(p.y(), 0.0f, 1.0f);
    const std::array<Influence, 2> row{{{a, 1.0f - upper}, {b, upper}}};
    rig.weights.append(row);
  }
  return rig;
}

TEST(DualQuaternion, one_bone_moves_the_mesh_rigidly) {
  Rig rig = capsule();
  Pose pose = Pose::rest(rig.skeleton);
  pose.rotations[JointId{0}] = Quatf(Eigen::AngleAxisf(0.7f, Vec3f(1, 2, 3).normalized()));
  pose.root_translation = {1, 2, 3};
  const auto transforms = skinning_transforms(rig.skeleton, pose);
  const auto posed = skin_dual_quaternion(rig, pose);
  for (VertexId v : rig.mesh.positions.ids()) EXPECT_VEC3_NEAR(posed[v], transforms[JointId{0}] * rig.mesh.positions[v], 1e-5f);
}

TEST(DualQuaternion, a_twist_keeps_the_radius_that_linear_blending_loses) {
  const Rig rig = capsule();
  Pose pose = Pose::rest(rig.skeleton);
  pose.rotations[JointId{1}] = Quatf(Eigen::AngleAxisf(0.9f * std::numbers::pi_v<float>, Vec3f::UnitY()));
  const auto linear = skin(rig, pose), dual = skin_dual_quaternion(rig, pose);
  const auto radius = [](const Vec3f& p) { return std::hypot(p.x(), p.z()); };
  float thinnest = 1.0f;
  for (VertexId v : rig.mesh.positions.ids()) {
    EXPECT_NEAR(radius(dual[v]), radius(rig.mesh.positions[v]), 1e-5f);
    if (radius(rig.mesh.positions[v]) > 0.09f) thinnest = std::min(thinnest, radius(linear[v]));
  }
  EXPECT_LT(thinnest, 0.03f);
}

TEST(DeformationScore, smooth_weights_stretch_less_than_a_hard_seam) {
  const Rig smooth = capsule();
  Rig hard = smooth;
  hard.weights = {};
  for (const Vec3f& p : hard.mesh.positions) {
    const Influence whole{JointId{p.y() > 0.5f ? std::uint16_t{1} : std::uint16_t{0}}, 1.0f};
    hard.weights.append({&whole, 1});
  }
  const DeformationScore of_smooth = deformation_score(smooth), of_hard = deformation_score(hard);
  ASSERT_EQ(of_smooth.joints.size(), 1u);
  EXPECT_EQ(of_smooth.joints[0].joint, JointId{1});
  EXPECT_LT(of_smooth.mean.stretch, of_hard.mean.stretch);
  EXPECT_EQ(of_smooth.mean.flips, 0.0);
}

TEST(DeformationScore, a_mesh_on_one_joint_does_not_deform) {
  Rig rig = capsule();
  rig.weights = {};
  const Influence whole{JointId{0}, 1.0f};
  for (std::size_t v = 0; v < rig.mesh.positions.size(); ++v) rig.weights.append({&whole, 1});
  EXPECT_TRUE(deformation_score(rig).joints.empty());
}

}  // namespace
}  // namespace osteon::skin
