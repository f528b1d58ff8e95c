// SPDX-License-Identifier: Apache-2.0
#include "osteon/skin/linear_blend.h"

#include <numbers>

#include "osteon/base/random.h"
#include "osteon/mesh/shapes.h"
#include "support/expect.h"

namespace osteon::skin {
namespace {

constexpr JointId j0{0}, j1{1};

// A capsule along y with a joint at its foot and one at half its height; weights go over linearly between y = 0.8 and 1.2.
Rig bendy() {
  Rig rig;
  rig.mesh = shapes::capsule(0.2f, 2.0f);
  rig.skeleton.add("foot", std::nullopt, {0, 0, 0});
  rig.skeleton.add("knee", j0, {0, 1, 0});
  for (const Vec3f& p : rig.mesh.positions) {
    const float upper = std::clamp((p.y() - 0.8f) / 0.4f, 0.0f, 1.0f);
    rig.weights.append(std::vector<Influence>{{j0, 1.0f - upper}, {j1, upper}});
  }
  validate(rig);
  return rig;
}

TEST(Skinning, the_rest_pose_moves_nothing) {
  const Rig rig = bendy();
  const auto posed = skin(rig, Pose::rest(rig.skeleton));
  for (VertexId v : rig.mesh.positions.ids()) EXPECT_VEC3_NEAR(posed[v], rig.mesh.positions[v], 1e-6f);
}

TEST(Skinning, one_joint_moves_the_mesh_rigidly) {
  Rig rig;
  rig.mesh = shapes::icosphere(2);
  rig.skeleton.add("only", std::nullopt, {0.5f, 0, 0});
  for (std::size_t v = 0; v < rig.mesh.positions.size(); ++v) rig.weights.append(std::vector<Influence>{{j0, 1.0f}});
  Pose pose = Pose::rest(rig.skeleton);
  pose.rotations[j0] = Eigen::AngleAxisf(std::numbers::pi_v<float> / 2, Vec3f::UnitZ());
  pose.root_translation = {0, 0, 3};
  const auto posed = skin(rig, pose);
  for (VertexId v : rig.mesh.positions.ids()) {
    const Vec3f arm = rig.mesh.positions[v] - Vec3f(0.5f, 0, 0);
    EXPECT_VEC3_NEAR(posed[v], Vec3f(0.5f, 0, 3) + Vec3f(-arm.y(), arm.x(), arm.z()), 1e-6f);
  }
}

TEST(Skinning, a_vertex_is_the_weighted_mean_of_where_its_joints_take_it) {
  const Rig rig = bendy();
  Pose pose = Pose::rest(rig.skeleton);
  pose.rotations[j1] = Eigen::AngleAxisf(1.0f, Vec3f::UnitX());
  const auto posed = skin(rig, pose);
  const auto transforms = skinning_transforms(rig.skeleton, pose);
  for (VertexId v : rig.mesh.positions.ids()) {
    const Vec3f& p = rig.mesh.positions[v];
    const float upper = std::clamp((p.y() - 0.8f) / 0.4f, 0.0f, 1.0f);
    EXPECT_VEC3_NEAR(posed[v], Vec3f((1 - upper) * p + upper * (transforms[j1] * p)), 1e-5f);
  }
}

}  // namespace
}  // namespace osteon::skin
