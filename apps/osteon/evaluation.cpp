// SPDX-License-Identifier: Apache-2.0
#include "evaluation.h"

#include <optional>

#include "osteon/base/parallel.h"
#include "osteon/dataset/clean_targets.h"
#include "osteon/geometry/joint_rays.h"
#include "progress_line.h"
#include "rigged_file.h"

namespace osteon::app {
namespace {

void normalise(Skeleton& skeleton, const geometry::Normalization& normalization) {
  for (Vec3f& p : skeleton.rest_positions) p = normalization.apply(p);
}

}  // namespace

Reference::Reference(Rig loaded) : rig(std::move(loaded)), normalization(geometry::normalization_of(rig.mesh)) {
  for (Vec3f& p : rig.mesh.positions) p = normalization.apply(p);
  normalise(rig.skeleton, normalization);
  tolerances =
      PerJoint<float>(geometry::joint_tolerances(rig.mesh, rig.skeleton.rest_positions.raw(), dataset::parent_indices(rig.skeleton)));
}

Skeleton Reference::in_frame(Skeleton predicted) const {
  normalise(predicted, normalization);
  return predicted;
}

metrics::SkeletonScores Reference::skeleton_scores(const Skeleton& predicted, float tolerance_scale) const {
  PerJoint<float> scaled = tolerances;
  for (float& tolerance : scaled) tolerance *= tolerance_scale;
  return metrics::compare_skeletons(in_frame(predicted), rig.skeleton, scaled);
}

metrics::SkinScores Reference::skin_scores(const SkinWeights& predicted) const { return metrics::compare_weights(rig, predicted); }

std::vector<std::string> for_each_character(const std::filesystem::path& data, const std::string& split,
                                            const std::function<void(std::size_t)>& prepare,
                                            const std::function<void(std::size_t, const Subject&)>& work) {
  const auto entries = dataset::read_manifest(data, split);
  prepare(entries.size());
  std::vector<std::string> failures(entries.size());
  ProgressLine progress("evaluating " + split, entries.size());
  parallel_for(entries.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      try {
        const Rig rig = load_rig(entries[i].file);
        work(i, {entries[i].info, rig, Reference(rig)});
      } catch (const Error& e) {
        failures[i] = entries[i].info.id + ": " + e.what();
      }
      progress.advance();
    }
  });
  std::erase(failures, std::string());
  return failures;
}

metrics::ConnectivityScores connectivity_scores(const Rig& rig, const infer::RignetModels& models,
                                                const pipelines::RignetOptions& options) {
  const geometry::Normalization frame = geometry::normalization_of(rig.mesh);
  Skeleton reference = rig.skeleton;
  normalise(reference, frame);
  reference = dataset::merge_coincident_joints(reference, dataset::PrepareOptions().merge_distance).skeleton;
  std::vector<Vec3f> joints;
  for (const Vec3f& p : reference.rest_positions) joints.push_back(frame.undo(p));
  const auto connected = pipelines::connect_joints(rig.mesh, joints, models, options);
  pipelines::TreeSkeleton tree = pipelines::make_skeleton(connected.joints, connected.tree, frame);
  for (JointId j : tree.from.ids()) tree.skeleton.names[j] = reference.names[static_cast<JointId>(tree.from[j])];
  return metrics::compare_connectivity(connected.evidence.bone_probability, connected.evidence.root_probability, tree.skeleton, reference);
}

metrics::SkinScores skin_scores(const Subject& subject, const infer::RignetModels& models, pipelines::RignetOptions options) {
  options.skeleton = subject.rig.skeleton;
  return subject.reference.skin_scores(pipelines::rig_character(subject.rig.mesh, models, options).weights);
}

}  // namespace osteon::app
