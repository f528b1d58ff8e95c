// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/rignet.h"

#include <fmt/format.h>

#include "osteon/geometry/stance.h"
#include "osteon/geometry/surroundings.h"
#include "osteon/geometry/wholeness.h"
#include "osteon/pipelines/body.h"
#include "osteon/pipelines/connectivity.h"
#include "osteon/pipelines/left_out.h"
#include "osteon/pipelines/mirrored_skin.h"
#include "osteon/pipelines/skeleton_prediction.h"
#include "osteon/pipelines/skin_networks.h"
#include "osteon/pipelines/stages.h"

namespace osteon::pipelines {
namespace {

// With z up, so much more of the attention points at a joint and so much surer is the rig than with y up, where only this tells the axis:
// on the validation characters, shown as if nothing else told it, that finds z in 12 of 26, and none that is y up is taken for z.
constexpr float kClearer = 0.08f, kSurer = 0.05f;
constexpr float kReach = 0.2f;  // a vertex farther than this from all bones is not covered

// A character as it was looked at, with one axis up.
struct Seen {
  Body body;
  Skeleton skeleton;  // in its frame
};

Seen look_at(const TriangleMesh& mesh, const infer::RignetModels& models, const RignetOptions& options, RignetResult& result,
             Stages& stages) {
  Seen seen{study(mesh, options, stages), {}};
  if (options.skeleton) {
    seen.skeleton = turned(*options.skeleton, seen.body.frame.turn);
    return seen;
  }
  PredictedSkeleton predicted = predict_skeleton(seen.body, models, options, result.report, stages);
  seen.skeleton = std::move(predicted.skeleton);
  result.joint_evidence = std::move(predicted.joint_evidence);
  result.character_evidence = predicted.character_evidence;
  return seen;
}

// Where its stance does not tell which axis is up, the character is looked at both ways. z is up where the votes gather clearly better
// then and the rig is surer. A mesh with y up may be taken so in one of the four ways that it can be turned and not in another.
Seen look_upright(const TriangleMesh& mesh, const infer::RignetModels& models, const RignetOptions& options, RignetResult& result,
                  Stages& stages, const Progress& progress) {
  Seen seen = look_at(mesh, models, options, result, stages);
  if (options.skeleton || options.up != Up::automatic || geometry::stance(mesh) != geometry::Stance::unclear) return seen;
  RignetOptions z_up = options;
  z_up.up = Up::z;
  RignetResult other;
  other.report.stages = result.report.stages;
  Stages more(other.report, progress);
  Seen lying = look_at(mesh, models, z_up, other, more);
  const RigReport &y = result.report, &z = other.report;
  if (*z.explained >= *y.explained + kClearer && z.confidence >= y.confidence + kSurer) {
    result = std::move(other);
    result.report.warnings.push_back(
        "how the character stands does not tell the up axis: z was taken, as the networks see it clearer then");
    return lying;
  }
  result.report.stages = std::move(other.report.stages);
  return seen;
}

std::optional<PerJoint<JointId>> joint_partners(const Skeleton& skeleton, const Body& body) {
  if (!body.symmetry) return std::nullopt;
  PerJoint<Vec3f> positions = skeleton.rest_positions;
  for (Vec3f& p : positions) p = body.working.normalization.apply(p);
  return mirror_partners(skeleton, positions, *body.symmetry);
}

// On the mesh that was given, and mirrored where it is.
SkinWeights finished(NetworkWeights raw, const Body& body, const Skeleton& skeleton, SkinPredictionOptions options) {
  if (raw.are_of_two) {
    options.smooth = options.smooth.value_or(0);  // together they are smooth by themselves, and what they call little is little
    options.prune_share = options.prune_share.value_or(0.05f);
  }
  const auto partners = joint_partners(skeleton, body);
  if (partners) raw.rows = mean_with_image(raw.rows, body.working.mesh, *body.symmetry, *partners);
  SkinWeights weights = finish_weights(raw.rows, body.working, body.ring, skeleton, options);
  if (!partners || !body.pairs) return weights;
  return mirrored_exactly(weights, body.working.clean.from_original, body.pairs->partner, *partners, options.max_influences);
}

void assess(const Body& body, const Skeleton& skeleton, const Matrix& distances, const RignetOptions& options, RigReport& report) {
  report.joints = skeleton.size();
  report.coverage = covered_share(distances, kReach);
  if (report.coverage < 0.9f)
    report.warnings.push_back(fmt::format("{:.0f} % of the character have no bone nearby{}", 100.0f * (1.0f - report.coverage),
                                          options.skeleton ? "" : ": with more detail there may be joints"));
  if (body.symmetry) {
    std::vector<Vec3f> points;
    for (const Vec3f& p : skeleton.rest_positions) points.push_back(body.working.normalization.apply(p));
    report.symmetry_error = mirror_error(points, *body.symmetry);
  }
  if (options.skeleton) report.confidence = report.coverage;
}

void warn_if_not_one_whole(const Body& body, std::vector<std::string>& warnings) {
  const TriangleMesh character = turned(body.working.clean.mesh, body.frame.turn.transpose());
  const Eigen::Index up = body.frame.is_z_up ? 2 : 1;
  if (geometry::is_open_at_a_side(character, up))
    warnings.push_back("the mesh is open along one of its sides: where it is half of a character, apply its mirror modifier first");
  if (geometry::stands_side_by_side(character, up))
    warnings.push_back("the mesh stands in two places side by side and was rigged as one character: several are to be rigged one by one");
}

// The joints are in the mesh's world coordinates.
ConnectedJoints connect_upright(const TriangleMesh& mesh, std::span<const Vec3f> joints, const infer::RignetModels& models,
                                const RignetOptions& options) {
  RigReport report;
  const Progress nobody;
  Stages stages(report, nobody);
  const Body body = study(mesh, options, stages);
  std::vector<Vec3f> positions;
  for (const Vec3f& p : joints) positions.push_back(body.working.normalization.apply(body.frame.turn * p));
  ConnectedJoints out;
  out.joints = joint_set_of(positions, body.symmetry);
  out.evidence = tree_evidence(out.joints, body, models, options.ablation);
  out.tree = connect(out.joints, out.evidence, options.tree);
  return out;
}

RignetResult rig_alone(const TriangleMesh& mesh, const infer::RignetModels& models, const RignetOptions& options,
                       const Progress& progress) {
  RignetResult result;
  RigReport& report = result.report;
  Stages stages(report, progress);
  Seen seen = look_upright(mesh, models, options, result, stages, progress);
  Body& body = seen.body;
  const Skeleton& skeleton = seen.skeleton;
  report.vertices = mesh.positions.size();
  report.working_vertices = body.positions().size();
  report.repairs = body.working.clean.repairs;
  report.up = body.frame.is_z_up ? 'z' : 'y';
  if (body.frame.is_z_up && geometry::stance(mesh) == geometry::Stance::on_z)
    report.warnings.push_back("the character stands on the plane z = 0: z was taken for its up axis");
  if (!options.skeleton) warn_if_not_one_whole(body, report.warnings);
  result.skeleton = options.skeleton ? *options.skeleton : turned(skeleton, body.frame.turn.transpose());
  const std::vector<Bone> list = normalised_bones(skeleton, body.working.normalization);
  if (is_too_coarse(list, skeleton.size(), body, options.working_mesh)) study_closer(body, mesh, options.working_mesh, stages);
  const Matrix distances = stages.run("bone distances", [&] { return distances_to(list, body, options.ablation); });
  NetworkWeights raw = network_weights(skeleton, list, distances, body, models, options.ablation, stages, report.warnings);
  result.weights = stages.run("weights", [&] { return finished(std::move(raw), body, skeleton, options.skin); });
  assess(body, skeleton, distances, options, report);
  return result;
}

}  // namespace

RignetResult rig_character(const TriangleMesh& mesh, const infer::RignetModels& models, const RignetOptions& options,
                           const Progress& progress) {
  validate(options);
  const std::span<const Vec3f> joints = options.skeleton ? options.skeleton->rest_positions.raw() : std::span<const Vec3f>{};
  const geometry::Surroundings around = geometry::surroundings(mesh, joints);
  if (around.vertices == 0) return rig_alone(mesh, models, options, progress);
  RignetResult result = rig_alone(geometry::without(mesh, around.has), models, options, progress);
  result.weights = with_surroundings(result.weights, around);
  result.report.vertices = mesh.positions.size();
  result.report.warnings.push_back(note_of(around));
  return result;
}

ConnectedJoints connect_joints(const TriangleMesh& mesh, std::span<const Vec3f> joints, const infer::RignetModels& models,
                               const RignetOptions& options) {
  validate(options);
  ConnectedJoints out = connect_upright(mesh, joints, models, options);
  if (options.up != Up::automatic || geometry::stance(mesh) != geometry::Stance::unclear) return out;
  RignetOptions z_up = options;
  z_up.up = Up::z;
  ConnectedJoints lying = connect_upright(mesh, joints, models, z_up);
  return lying.tree.likelihood > out.tree.likelihood ? lying : out;
}

}  // namespace osteon::pipelines
