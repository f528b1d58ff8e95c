// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/skin_character.h"

#include "osteon/base/error.h"
#include "osteon/pipelines/left_out.h"
#include "osteon/pipelines/mirrored_skin.h"
#include "osteon/pipelines/neuroskinning.h"
#include "osteon/pipelines/rignet.h"
#include "osteon/pipelines/skin_quality.h"

namespace osteon::pipelines {
namespace {

skin::Binding by_rignet(const TriangleMesh& mesh, const Skeleton& skeleton, const SkinCharacterOptions& options) {
  RignetOptions rignet;
  rignet.skeleton = skeleton;
  rignet.skin.max_influences = options.bind.max_influences;
  rignet.skin.smooth = options.bind.smooth;
  rignet.skin.prune_share = options.bind.prune_share;
  rignet.skin.rigid_islands = options.bind.islands == skin::Islands::rigid;
  if (!options.neuroskinning) rignet.ablation.neuroskinning = 0.0f;
  RignetResult result = rig_character(mesh, *options.rignet, rignet);
  return {std::move(result.weights), 0, std::move(result.report.warnings), std::move(result.report.repairs)};
}

skin::Binding by_neuroskinning(const TriangleMesh& mesh, const Skeleton& skeleton, const SkinCharacterOptions& options) {
  NeuroskinningOptions neuro;
  neuro.max_influences = options.bind.max_influences;
  neuro.smooth = options.bind.smooth.value_or(neuro.smooth);
  neuro.prune_share = options.bind.prune_share.value_or(neuro.prune_share);
  neuro.rigid_islands = options.bind.islands == skin::Islands::rigid;
  NeuroskinningResult result = neuroskinning_weights(mesh, skeleton, *options.neuroskinning, neuro);
  return {std::move(result.weights), result.rigid_islands, std::move(result.warnings), std::move(result.repairs)};
}

skin::Binding by_networks(const TriangleMesh& mesh, const Skeleton& skeleton, const SkinCharacterOptions& options) {
  skin::Binding out = options.rignet ? by_rignet(mesh, skeleton, options) : by_neuroskinning(mesh, skeleton, options);
  if (!options.bind.locked.empty())
    out.weights = skin::with_locked(out.weights, options.bind.before.value(), options.bind.locked, options.bind.max_influences);
  return out;
}

bool is_by_networks(const SkinCharacterOptions& options) { return options.rignet || options.neuroskinning; }

skin::Binding skin_alone(const TriangleMesh& mesh, const Skeleton& skeleton, const SkinCharacterOptions& options) {
  skin::Binding out = is_by_networks(options) ? by_networks(mesh, skeleton, options) : skin::bind(mesh, skeleton, options.bind);
  if (!options.mirror) return out;
  const auto mirror = mirror_map(mesh, skeleton);
  if (!mirror) throw Error("mirror: the mesh or the skeleton is not its own mirror image; expected a partner for every vertex and joint");
  out.weights =
      mirrored_exactly(out.weights, mirror->from_original, mirror->vertex_partner, mirror->joint_partner, options.bind.max_influences);
  return out;
}

}  // namespace

skin::Binding skin_character(const TriangleMesh& mesh, const Skeleton& skeleton, const SkinCharacterOptions& options) {
  if (!is_by_networks(options) && options.bind.method == skin::Method::transfer) return skin_alone(mesh, skeleton, options);
  const geometry::Surroundings around = geometry::surroundings(mesh, skeleton.rest_positions.raw());
  if (around.vertices == 0) return skin_alone(mesh, skeleton, options);
  SkinCharacterOptions unlocked = options;
  unlocked.bind.locked = {};
  skin::Binding out = skin_alone(geometry::without(mesh, around.has), skeleton, unlocked);
  out.weights = with_surroundings(out.weights, around);
  if (!options.bind.locked.empty())
    out.weights = skin::with_locked(out.weights, options.bind.before.value(), options.bind.locked, options.bind.max_influences);
  out.notes.push_back(note_of(around));
  return out;
}

}  // namespace osteon::pipelines
