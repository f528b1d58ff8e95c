// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/skeleton_prediction.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "osteon/pipelines/connectivity.h"
#include "osteon/pipelines/edge_loops.h"
#include "osteon/pipelines/hands.h"
#include "osteon/pipelines/joint_extraction.h"
#include "osteon/pipelines/joint_votes.h"

namespace osteon::pipelines {
namespace {

constexpr float kHandDetail = 0.4f;        // coarser rigs have no fingers,
constexpr std::size_t kJointsOfBody = 15;  // nor those of which so few joints would be left for the body
constexpr int kCountRounds = 4;            // to a number of joints that is asked for

JointExtraction find_joints(const JointCandidates& seen, float expected, std::optional<std::size_t> count, const Body& body,
                            const RignetOptions& options) {
  JointExtractionOptions extraction = options.extraction;
  extraction.expected_joints = expected;
  if (body.pairs) extraction.one_sided_share = 0.0f;  // where nothing is one-sided, all pairs stay
  if (count) return extract_joint_count(seen, body.voxels, body.symmetry, *count, extraction);
  extraction.bandwidth = options.bandwidth.value_or(bandwidth_of_detail(options.detail));
  return extract_joints(seen, body.voxels, body.symmetry, extraction);
}

// The votes that count where a study leaves something out; the first of the views shows the character as it is.
JointCandidates heard(JointCandidates votes, std::size_t vertices, const Ablation& ablation) {
  if (!ablation.views) {
    votes.positions.resize(vertices);
    votes.attention.resize(vertices);
  }
  if (!ablation.attention) std::ranges::fill(votes.attention, 1.0f);
  return votes;
}

// A valid rig, in the body's frame, for a character in which no joints were seen.
Skeleton single_joint(const Body& body) {
  const auto& positions = body.positions();
  const Vec3f mean = std::accumulate(positions.begin(), positions.end(), Vec3f(Vec3f::Zero())) / static_cast<float>(positions.size());
  Skeleton skeleton;
  skeleton.add("root", std::nullopt, body.working.normalization.undo(mean));
  return skeleton;
}

void warn_about_joints(const JointExtraction& found, std::size_t joints, const RignetOptions& options, std::vector<std::string>& warnings) {
  if (joints == 0) warnings.push_back("no joints were found: the rig is a single joint in the middle");
  if (!found.inside_used) warnings.push_back("the mesh encloses hardly any volume: joints may lie outside of it");
  if (options.joints && joints != *options.joints)
    warnings.push_back(fmt::format("{} joints were asked for; the nearest that was found is {}", *options.joints, joints));
}

// How far the joints can be trusted. `from`: for each joint of the result the one that was found; none: a hand's.
std::vector<std::optional<JointEvidence>> evidence_of_result(const std::vector<JointEvidence>& evidence,
                                                             const PerJoint<std::optional<std::size_t>>& from) {
  std::vector<std::optional<JointEvidence>> out;
  for (const auto& joint : from) out.push_back(joint ? std::optional(evidence[*joint]) : std::nullopt);
  return out;
}

// All but the hands' joints, which are in their places.
JointSet drawn_to_edge_loops(const SkeletonDraft& draft, std::span<const Vec3f> vertices) {
  JointSet out = pipelines::drawn_to_edge_loops(draft.joints, draft.tree, vertices);
  for (std::size_t j = 0; j < out.size(); ++j)
    if (draft.part[j]) out.positions[j] = draft.joints.positions[j];
  return out;
}

// Joints, connected and in their places, and those of the hands.
struct Grown {
  JointExtraction found;
  SkeletonDraft skeleton;  // without joints where none were found
};

Grown grow(const JointCandidates& seen, float wanted, std::optional<std::size_t> count, bool hands, const Body& body,
           const infer::RignetModels& models, const RignetOptions& options, Stages& stages) {
  Grown out{stages.run("joints", [&] { return find_joints(seen, wanted, count, body, options); }), {}};
  if (out.found.joints.size() == 0) return out;
  const JointSet& found = out.found.joints;
  const TreeEvidence known = stages.run("connectivity networks", [&] { return tree_evidence(found, body, models, options.ablation); });
  const JointTree tree = stages.run("tree", [&] { return connect(found, known, options.tree); });
  const TriangleMesh mesh = original_mesh(body);
  SkeletonDraft& draft = out.skeleton;
  draft = SkeletonDraft::of(found, tree);
  if (hands) draft = stages.run("hands", [&] { return with_hands(found, tree, mesh, body.pairs.has_value()); });
  if (options.ablation.edge_loops)
    draft.joints = stages.run("edge loops", [&] { return drawn_to_edge_loops(draft, mesh.positions.raw()); });
  return out;
}

// Where a number of joints is asked for, hands are among them if enough are left for the body. How many of its joints they take the
// place of is known afterwards only.
Grown grow_to_count(const JointCandidates& seen, float wanted, const Body& body, const infer::RignetModels& models,
                    const RignetOptions& options, Stages& stages) {
  const bool fine = options.joints || options.bandwidth.value_or(bandwidth_of_detail(options.detail)) <= bandwidth_of_detail(kHandDetail);
  const bool hands = options.fingers == Fingers::automatic && fine;
  Grown grown = grow(seen, wanted, options.joints, hands, body, models, options, stages);
  const auto is_of_hand = [](const auto& part) { return part.has_value(); };
  const auto of_hands = static_cast<std::size_t>(std::ranges::count_if(grown.skeleton.part, is_of_hand));
  if (!options.joints || of_hands == 0) return grown;
  if (*options.joints < of_hands + kJointsOfBody) return grow(seen, wanted, options.joints, false, body, models, options, stages);
  const auto miss = [&](const Grown& g) {
    return std::max(g.skeleton.joints.size(), *options.joints) - std::min(g.skeleton.joints.size(), *options.joints);
  };
  std::size_t count = *options.joints - of_hands;
  for (int round = 0; round < kCountRounds && miss(grown) > 0; ++round) {
    Grown tried = grow(seen, wanted, count, true, body, models, options, stages);
    const std::size_t wished = count + *options.joints, had = tried.skeleton.joints.size();
    if (miss(tried) < miss(grown)) grown = std::move(tried);
    const std::size_t next = wished > had + kJointsOfBody ? wished - had : kJointsOfBody;
    if (next == count) break;
    count = next;
  }
  return grown;
}

// Without the joints that a hand took the place of. `evidence`: of the joints that were found.
CharacterEvidence evidence_of(const Grown& grown, const std::vector<JointEvidence>& evidence) {
  std::vector<JointEvidence> of_body;
  for (const auto& joint : grown.skeleton.from)
    if (joint) of_body.push_back(evidence[*joint]);
  return character_evidence(of_body, grown.found.explained, grown.skeleton.tree.likelihood);
}

bool are_usual_joints(const RignetOptions& options) {
  return !options.joints && !options.bandwidth && options.detail == RignetOptions{}.detail;
}

// Whether it is a character at all is asked of the usual joints, whatever number is wished: fewer would explain less of what is seen, and
// more would have less certain bones.
CharacterEvidence evidence_of_usual_joints(const JointCandidates& seen, const Body& body, const infer::RignetModels& models,
                                           const RignetOptions& options, Stages& stages) {
  RignetOptions usual = options;
  usual.detail = RignetOptions{}.detail;
  usual.bandwidth.reset();
  usual.joints.reset();
  const Grown grown = grow(seen, expected_joints(body.triangles, usual.detail), std::nullopt, false, body, models, usual, stages);
  return evidence_of(grown, joint_evidence(seen, grown.found.joints, body.working.mesh));
}

}  // namespace

PredictedSkeleton predict_skeleton(const Body& body, const infer::RignetModels& models, const RignetOptions& options, RigReport& report,
                                   Stages& stages) {
  const float wanted = options.joints ? static_cast<float>(*options.joints) : expected_joints(body.triangles, options.detail);
  const JointCandidates seen = stages.run("joint networks", [&] {
    return heard(joint_votes(body.working.mesh, body.graph, body.regions, models, wanted), body.positions().size(), options.ablation);
  });
  const Grown grown = grow_to_count(seen, wanted, body, models, options, stages);
  warn_about_joints(grown.found, grown.skeleton.joints.size(), options, report.warnings);
  report.bandwidth = grown.found.bandwidth;
  report.explained = grown.found.explained;
  report.bone_confidence = report.character = 0.0f;
  if (grown.skeleton.joints.size() == 0) return {single_joint(body), {}, {}};
  report.bone_confidence = grown.skeleton.tree.likelihood;
  TreeSkeleton made = make_skeleton(grown.skeleton.joints, grown.skeleton.tree, body.working.normalization, body.frame.is_seen_from_behind,
                                    grown.skeleton.part);
  PerJoint<std::optional<std::size_t>> from;
  for (std::size_t joint : made.from) from.push_back(grown.skeleton.from[joint]);
  const std::vector<JointEvidence> evidence = joint_evidence(seen, grown.found.joints, body.working.mesh);
  PredictedSkeleton out{std::move(made.skeleton), evidence_of_result(evidence, from), {}};
  out.character_evidence =
      are_usual_joints(options) ? evidence_of(grown, evidence) : evidence_of_usual_joints(seen, body, models, options, stages);
  report.character = character_probability(out.character_evidence);
  for (const auto& joint : out.joint_evidence) report.joint_confidence.push_back(joint ? joint_confidence(*joint) : kHandConfidence);
  const auto& sure = report.joint_confidence;
  report.confidence = *report.character * std::accumulate(sure.begin(), sure.end(), 0.0f) / static_cast<float>(sure.size());
  return out;
}

}  // namespace osteon::pipelines
