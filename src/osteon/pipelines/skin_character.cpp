// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/skin_character.h"

#include "osteon/base/error.h"
#include "osteon/pipelines/mirrored_skin.h"
#include "osteon/pipelines/rignet.h"
#include "osteon/pipelines/skin_quality.h"

namespace osteon::pipelines {
namespace {

skin::Binding by_networks(const TriangleMesh& mesh, const Skeleton& skeleton, const SkinCharacterOptions& options) {
  RignetOptions rignet;
  rignet.skeleton = skeleton;
  rignet.skin.max_influences = options.bind.max_influences;
  RignetResult result = rig_character(mesh, *options.rignet, rignet);
  skin::Binding out;
  out.weights = std::move(result.weights);
  out.notes = std::move(result.report.warnings);
  out.repairs = std::move(result.report.repairs);
  if (!options.bind.locked.empty())
    out.weights = skin::with_locked(out.weights, options.bind.before.value(), options.bind.locked, options.bind.max_influences);
  return out;
}

}  // namespace

skin::Binding skin_character(const TriangleMesh& mesh, const Skeleton& skeleton, const SkinCharacterOptions& options) {
  skin::Binding out = options.rignet ? by_networks(mesh, skeleton, options) : skin::bind(mesh, skeleton, options.bind);
  if (!options.mirror) return out;
  const auto mirror = mirror_map(mesh, skeleton);
  if (!mirror) throw Error("mirror: the mesh or the skeleton is not its own mirror image; expected a partner for every vertex and joint");
  out.weights =
      mirrored_exactly(out.weights, mirror->from_original, mirror->vertex_partner, mirror->joint_partner, options.bind.max_influences);
  return out;
}

}  // namespace osteon::pipelines
