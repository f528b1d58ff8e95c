// SPDX-License-Identifier: Apache-2.0
#include "osteon/dataset/neuro.h"

#include <algorithm>
#include <cassert>

#include "osteon/skin/neuro_features.h"

namespace osteon::dataset {
namespace {

constexpr float kAbsent = -1e4f;  // added to the logits of slots that the skeleton has not

static_assert(skin::kChoiceFeatures == nets::neuro_choice_features && skin::kJointFeatures == nets::neuro_joint_features);

Matrix joint_weights(const PreparedCharacter& character) {
  Matrix out = Matrix::Zero(static_cast<Eigen::Index>(character.vertices()), static_cast<Eigen::Index>(character.joints()));
  for (VertexId v : character.mesh.positions.ids())
    for (const Influence& i : character.weights[v])
      out(static_cast<Eigen::Index>(index(v)), static_cast<Eigen::Index>(index(i.joint))) += i.weight;
  return out;
}

struct Placed {
  std::vector<Vec3f> positions, normals;
  Skeleton skeleton;
};

Placed placed(const PreparedCharacter& character, const Placement& placement) {
  Placed out{{}, vertex_normals(character.mesh).raw(), character.skeleton};
  for (const Vec3f& p : character.mesh.positions) out.positions.push_back(placement.apply(p));
  const Eigen::Matrix3f of_normals = placement.linear.inverse().transpose();
  for (Vec3f& n : out.normals) n = (of_normals * n).normalized();
  for (Vec3f& p : out.skeleton.rest_positions) p = placement.apply(p);
  return out;
}

void add_choices(Batch& batch, const Example& example, const Placed& body, const Placement& placement, const skin::SuperSkeleton& super,
                 const skin::SlotAssignment& assignment) {
  skin::BoneChoices choices = example.bone_choices;
  for (Segment& s : choices.bones.segments) s = {placement.apply(s.a), placement.apply(s.b)};
  choices.distances *= placement.length_scale;
  const skin::ChoiceRows rows =
      skin::choice_rows(body.positions, body.normals, body.skeleton, choices, super, assignment, nets::neuro_kinds);
  nets::NeuroArrays& neuro = batch.inputs.neuro;
  neuro.choices.add(rows.features, rows.offsets, rows.joints);
  neuro.joints.insert(neuro.joints.end(), rows.joint_features.begin(), rows.joint_features.end());
  BatchTargets& targets = batch.targets;
  targets.log_shares.insert(targets.log_shares.end(), rows.log_shares.begin(), rows.log_shares.end());
  for (Eigen::Index v = 0; v < choices.nearest.rows(); ++v)
    for (Eigen::Index k = 0; k < choices.nearest.cols(); ++k)
      if (choices.nearest(v, k) >= 0) targets.skin.push_back(example.skin_targets.weights(v, k));
  targets.skin_share.insert(targets.skin_share.end(), example.skin_targets.covered.begin(), example.skin_targets.covered.end());
}

void add_slots(Batch& batch, const Example& example, const Placed& body, const skin::SuperSkeleton& super,
               const skin::SlotAssignment& assignment) {
  const std::vector<float> rows = skin::slot_rows(body.positions, body.normals, body.skeleton, super, assignment, nets::neuro_slots);
  std::vector<float>& features = batch.inputs.neuro.features;
  features.insert(features.end(), rows.begin(), rows.end());
  std::vector<float> absent(nets::neuro_slots, kAbsent);
  for (const std::size_t slot : assignment.slot) absent[slot] = 0.0f;
  BatchTargets& targets = batch.targets;
  const PreparedCharacter& character = example.character;
  for (VertexId v : character.mesh.positions.ids()) {
    targets.slots.insert(targets.slots.end(), absent.begin(), absent.end());
    targets.skin.resize(targets.skin.size() + nets::neuro_slots, 0.0f);
    float* row = targets.skin.data() + targets.skin.size() - nets::neuro_slots;
    for (const Influence& i : character.weights[v]) row[assignment.slot[i.joint]] += i.weight;
    targets.skin_share.push_back(1.0f);
  }
}

}  // namespace

void derive_neuro(Example& example, const PreparedCharacter& character, Parts parts) {
  example.wide_balls = geometry::geodesic_balls(character.mesh, 0.25f, nets::neuro_pooling.back() - 1);
  if (parts != Parts::neuro) return;
  example.bone_choices = skin::bone_choices(character.mesh, character.skeleton);
  example.skin_targets = geometry::skin_targets(joint_weights(character), example.bone_choices.bones.starts, example.bone_choices.nearest);
}

void add_neuro(Batch& batch, const Example& example, const Placement& placement, const BatchOptions& options, bool named) {
  assert(options.super_skeleton);
  const Placed body = placed(example.character, placement);
  const skin::SuperSkeleton& super = *options.super_skeleton;
  const skin::SlotAssignment assignment = super.assign(body.skeleton, named);
  const auto& starts = batch.inputs.mesh.batch.offsets;
  batch.inputs.neuro.add_nearest(example.wide_balls.members.offsets, example.wide_balls.members.members, starts[starts.size() - 2]);
  if (options.parts == Parts::neuro)
    add_choices(batch, example, body, placement, super, assignment);
  else
    add_slots(batch, example, body, super, assignment);
}

}  // namespace osteon::dataset
