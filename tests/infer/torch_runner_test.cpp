// SPDX-License-Identifier: Apache-2.0
#include "osteon/torch_infer/torch_runner.h"

#include <thread>

#include "osteon/infer/model_folder.h"
#include "osteon/pipelines/rignet.h"
#include "osteon/synth/character.h"
#include "support/expect.h"

namespace osteon::torch_infer {
namespace {

infer::RignetModels shipped_on_torch() { return infer::RignetModels::load(infer::find_models("rignet"), torch_runners("cpu")); }

// The largest difference of the joints, which are as many.
float difference(const Skeleton& a, const Skeleton& b) {
  float most = 0.0f;
  for (JointId j : a.names.ids()) most = std::max(most, (a.rest_positions[j] - b.rest_positions[j]).norm());
  return most;
}

TEST(TorchRunner, rigs_a_character_as_onednn_does) {
  const TriangleMesh mesh = synth::make_character(synth::Kind::Biped, 3, {.cells = 40}).mesh;
  const auto own = pipelines::rig_character(mesh, infer::RignetModels::load()), torch = pipelines::rig_character(mesh, shipped_on_torch());
  ASSERT_EQ(own.skeleton.names.raw(), torch.skeleton.names.raw());
  EXPECT_EQ(own.skeleton.parents.raw(), torch.skeleton.parents.raw());
  EXPECT_LT(difference(own.skeleton, torch.skeleton), 1e-3f * geometry::normalization_of(mesh).undo(Vec3f::Ones()).norm());
}

TEST(TorchRunner, may_be_used_by_two_threads_at_once) {
  const infer::RignetModels models = shipped_on_torch();
  const TriangleMesh mesh = synth::make_character(synth::Kind::Fish, 2, {.cells = 24}).mesh;
  const Skeleton expected = pipelines::rig_character(mesh, models).skeleton;
  Skeleton other;
  std::thread thread([&] { other = pipelines::rig_character(mesh, models).skeleton; });
  const Skeleton own = pipelines::rig_character(mesh, models).skeleton;
  thread.join();
  ASSERT_EQ(own.size(), expected.size());
  ASSERT_EQ(other.size(), expected.size());
  EXPECT_LT(difference(own, expected), 1e-4f);
  EXPECT_LT(difference(other, expected), 1e-4f);
}

TEST(TorchRunner, refuses_a_device_that_is_not_there) {
  EXPECT_THAT(test::error_of([] { torch_runners("quantum"); }), testing::HasSubstr("device quantum"));
}

}  // namespace
}  // namespace osteon::torch_infer
