// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/rignet.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <string_view>

#include "osteon/base/error.h"
#include "osteon/geometry/bind_features.h"
#include "osteon/geometry/mirror_pairs.h"
#include "osteon/geometry/neighbourhoods.h"
#include "osteon/geometry/rignet_features.h"
#include "osteon/geometry/stance.h"
#include "osteon/geometry/symmetry.h"
#include "osteon/geometry/tree_features.h"
#include "osteon/geometry/volumetric_geodesic.h"
#include "osteon/geometry/voxel_grid.h"
#include "osteon/geometry/working_mesh.h"
#include "osteon/pipelines/edge_loops.h"
#include "osteon/pipelines/hands.h"
#include "osteon/pipelines/joint_votes.h"
#include "osteon/pipelines/mirrored_skin.h"
#include "osteon/pipelines/neuroskinning.h"
#include "osteon/skin/distance_weights.h"

namespace osteon::pipelines {
namespace {

constexpr std::size_t kGeodesicNeighbours = 10;  // of a vertex, as in training (dataset::BatchOptions)
constexpr float kGeometricShare = 0.5f;          // in NeuroSkinning's part of the weights: a quarter of all
// With z up, so much more of the attention points at a joint and so much surer is the rig than with y up, where only this tells the axis:
// on the validation characters, shown as if nothing else told it, that finds z in 12 of 26, and none that is y up is taken for z.
constexpr float kClearer = 0.08f, kSurer = 0.05f;
constexpr float kHandDetail = 0.4f;        // coarser rigs have no fingers,
constexpr std::size_t kJointsOfBody = 15;  // nor those of which so few joints would be left for the body
constexpr int kCountRounds = 4;            // to a number of joints that is asked for
// Where so many joints have fewer vertices of the working mesh to themselves, the skin is found on a finer one: on training and validation
// characters that have (all with fingers) L1 falls by a tenth to a third, with as many joints elsewhere it does not.
constexpr std::size_t kManyJoints = 20, kFewVertices = 4, kFineVertices = 4000;
constexpr float kReach = 0.2f;  // a vertex farther than this from all bones is not covered

// Runs the stages one after the other: tells the progress, and notes how long each took.
class Stages {
 public:
  Stages(RigReport& report, const Progress& progress) : report_(report), progress_(progress) {}

  template <class Work>
  auto run(std::string_view name, const Work& work) {
    constexpr double kStages = 20.0;
    if (progress_) progress_(name, std::min(1.0, static_cast<double>(report_.stages.size()) / kStages));
    const auto start = std::chrono::steady_clock::now();
    auto result = work();
    report_.stages.push_back({std::string(name), std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()});
    return result;
  }

 private:
  RigReport& report_;
  const Progress& progress_;
};

// What the stages know of the character, in its own frame, normalised.
struct Body {
  BodyFrame frame;
  geometry::WorkingMesh working;
  geometry::Neighbourhoods ring;
  nets::MeshArrays graph;
  geometry::Regions regions;  // of the surface, for the votes
  geometry::VoxelGrid voxels;
  std::optional<Plane> symmetry;
  std::optional<geometry::MirrorPairs> pairs;  // of working.clean.mesh
  std::size_t triangles = 0;                   // of the mesh that was given

  const std::vector<Vec3f>& positions() const { return working.mesh.positions.raw(); }
};

void check(const RignetOptions& options) {
  if (options.bandwidth && !(*options.bandwidth >= kFinestBandwidth && *options.bandwidth <= kCoarsestBandwidth))
    throw Error("bandwidth: {} found, expected {} to {}", *options.bandwidth, kFinestBandwidth, kCoarsestBandwidth);
  if (!(options.detail >= 0.0f && options.detail <= 1.0f)) throw Error("detail: {} found, expected 0 to 1", options.detail);
  if (options.joints && *options.joints < 1) throw Error("joints: 0 found, expected at least 1");
  if (options.skin.max_influences < 1) throw Error("max influences: 0 found, expected at least 1");
  if (options.ablation.bones < 1 || options.ablation.bones > geometry::kBindBones)
    throw Error("bones of a vertex: {} found, expected 1 to {}", options.ablation.bones, geometry::kBindBones);
  if (options.skeleton) validate(*options.skeleton);
}

// The working mesh in the body's frame, and the plane of symmetry.
std::optional<Plane> stand(Body& body, const TriangleMesh& mesh, const RignetOptions& options, Stages& stages) {
  const auto look = [&] {
    body.working =
        stages.run("working mesh", [&] { return geometry::make_working_mesh(turned(mesh, body.frame.turn), options.working_mesh); });
    return stages.run("symmetry", [&] { return geometry::symmetry_plane(body.working.mesh); });
  };
  body.frame = stages.run("body frame", [&] { return body_frame(mesh, options.up); });
  std::optional<Plane> symmetry = look();
  for (int turns = 0; symmetry && turns < 2; ++turns) {
    const auto better = aligned(body.frame, *symmetry, mesh);
    if (!better) break;
    body.frame = *better;
    symmetry = look();
  }
  return symmetry;
}

std::optional<geometry::MirrorPairs> pairs_of(const geometry::WorkingMesh& working, const Plane& symmetry) {
  TriangleMesh mesh = working.clean.mesh;
  for (Vec3f& p : mesh.positions) p = working.normalization.apply(p);
  return geometry::mirror_pairs(mesh, symmetry);
}

// What all networks need to know of the working mesh.
geometry::GeodesicBalls survey(Body& body, Stages& stages) {
  const TriangleMesh& working = body.working.mesh;
  body.ring = geometry::one_ring(working);
  auto balls = stages.run("neighbourhoods", [&] { return geometry::geodesic_balls(working); });
  const auto geodesic = geometry::evenly(balls, kGeodesicNeighbours);
  body.graph = infer::single_mesh(body.positions(), {body.ring.offsets, body.ring.members}, {geodesic.offsets, geodesic.members});
  body.voxels = stages.run("voxels", [&] { return geometry::voxelize(working); });
  return balls;
}

Body study(const TriangleMesh& mesh, const RignetOptions& options, Stages& stages) {
  Body body;
  body.triangles = mesh.faces.size();
  const std::optional<Plane> symmetry = stand(body, mesh, options, stages);
  if (options.symmetry == Symmetry::automatic && symmetry) {
    body.pairs = stages.run("mirror pairs", [&] { return pairs_of(body.working, *symmetry); });
    body.symmetry = body.pairs ? body.pairs->plane : *symmetry;
  }
  const geometry::GeodesicBalls balls = survey(body, stages);
  const TriangleMesh& working = body.working.mesh;
  body.regions =
      stages.run("regions", [&] { return geometry::regions(working, balls, nets::vote_regions, geometry::outermost_vertex(working)); });
  return body;
}

// For the skin of what is finer than the working mesh: one with more vertices, and no regions. Pre: `options` ask for fewer.
void study_closer(Body& body, const TriangleMesh& mesh, geometry::WorkingMeshOptions options, Stages& stages) {
  options.max_vertices += kFineVertices - options.target_vertices;
  options.target_vertices = kFineVertices;
  body.working = stages.run("working mesh", [&] { return geometry::make_working_mesh(turned(mesh, body.frame.turn), options); });
  survey(body, stages);
}

JointExtraction find_joints(const JointCandidates& seen, float expected, std::optional<std::size_t> count, const Body& body,
                            const RignetOptions& options) {
  JointExtractionOptions extraction = options.extraction;
  extraction.expected_joints = expected;
  if (body.pairs) extraction.one_sided_share = 0.0f;  // where nothing is one-sided, all pairs stay
  if (count) return extract_joint_count(seen, body.voxels, body.symmetry, *count, extraction);
  extraction.bandwidth = options.bandwidth.value_or(bandwidth_of_detail(options.detail));
  return extract_joints(seen, body.voxels, body.symmetry, extraction);
}

Matrix symmetric(const Matrix& of_pairs, std::size_t joints) {
  const auto n = static_cast<Eigen::Index>(joints);
  Matrix out = Matrix::Zero(n, n);
  Eigen::Index pair = 0;
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = i + 1; j < n; ++j) out(i, j) = out(j, i) = of_pairs(pair++, 0);
  return out;
}

// How likely bones are where nothing but their length counts.
Matrix nearness(const std::vector<Vec3f>& positions) {
  constexpr float kLength = 0.1f;  // the tree is the same for any
  const auto n = static_cast<Eigen::Index>(positions.size());
  Matrix out(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      out(i, j) = std::exp(-(positions[static_cast<std::size_t>(i)] - positions[static_cast<std::size_t>(j)]).norm() / kLength);
  return out;
}

// Who belongs together and who is the root, where it is known of each joint how likely the others are its parent.
TreeEvidence evidence_of_parents(const Matrix& parents, Matrix outside) {
  TreeEvidence out{(parents + parents.transpose()).cwiseMin(1.0f), {}, std::move(outside)};
  const float sum = std::max(parents.diagonal().sum(), 1e-6f);
  for (const float own : parents.diagonal()) out.root_probability.push_back(own / sum);
  return out;
}

Matrix parent_probabilities(std::span<const Vec3f> joints, const nets::JointArrays& arrays, const Plane& plane, const Body& body,
                            const infer::RignetModels& models) {
  std::vector<Vec3f> images;
  for (const Vec3f& p : joints) images.push_back(plane.mirror(p));
  const Matrix inside = geometry::inside_shares(joints, body.voxels);
  const geometry::TreeFeatures features = geometry::tree_features({joints, images, body.positions(), inside});
  nets::TreeArrays tree;
  tree.add({features.joints.data(), static_cast<std::size_t>(features.joints.size())},
           {features.pairs.data(), static_cast<std::size_t>(features.pairs.size())});
  return models.parent_probabilities(arrays, tree);
}

TreeEvidence evidence(const JointSet& joints, const Body& body, const infer::RignetModels& models, const Ablation& ablation) {
  const std::vector<Vec3f> positions = joints.normalised();
  const Plane plane = body.symmetry.value_or(Plane{Vec3f::UnitX(), 0.0f});
  std::vector<float> plane_distances;
  for (const Vec3f& p : positions) plane_distances.push_back(std::abs(plane.signed_distance(p)));
  const nets::JointArrays arrays = infer::single_skeleton(positions, plane_distances);
  if (models.finds_parents()) {
    TreeEvidence known =
        evidence_of_parents(parent_probabilities(positions, arrays, plane, body, models), samples_outside(positions, body.voxels));
    if (!ablation.bone_network) known.bone_probability = nearness(positions);
    return known;
  }
  const Matrix root = models.root_probabilities(body.graph, arrays);
  const auto bones = [&] {
    if (!ablation.bone_network) return nearness(positions);
    if (positions.size() == 1) return symmetric(Matrix(0, 1), 1);
    return symmetric(models.bone_probabilities(body.graph, arrays, geometry::pair_features(positions, body.voxels)), positions.size());
  };
  return {bones(), {root.data(), root.data() + root.size()}, samples_outside(positions, body.voxels)};
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
void judge_joints(const std::vector<JointEvidence>& evidence, const PerJoint<std::optional<std::size_t>>& from, RignetResult& result) {
  for (const auto& joint : from) {
    result.joint_evidence.push_back(joint ? std::optional(evidence[*joint]) : std::nullopt);
    result.report.joint_confidence.push_back(joint ? joint_confidence(evidence[*joint]) : kHandConfidence);
  }
}

// Normalised, and not reduced.
TriangleMesh original_mesh(const Body& body) {
  TriangleMesh out = body.working.clean.mesh;
  for (Vec3f& p : out.positions) p = body.working.normalization.apply(p);
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
  const TreeEvidence known = stages.run("connectivity networks", [&] { return evidence(found, body, models, options.ablation); });
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

// In the body's frame, in the unit of the mesh.
Skeleton predict_skeleton(const Body& body, const infer::RignetModels& models, const RignetOptions& options, RignetResult& result,
                          Stages& stages) {
  RigReport& report = result.report;
  const float wanted = options.joints ? static_cast<float>(*options.joints) : expected_joints(body.triangles, options.detail);
  const JointCandidates seen = stages.run("joint networks", [&] {
    return heard(joint_votes(body.working.mesh, body.graph, body.regions, models, wanted), body.positions().size(), options.ablation);
  });
  const Grown grown = grow_to_count(seen, wanted, body, models, options, stages);
  warn_about_joints(grown.found, grown.skeleton.joints.size(), options, report.warnings);
  report.bandwidth = grown.found.bandwidth;
  report.explained = grown.found.explained;
  report.bone_confidence = report.character = 0.0f;
  if (grown.skeleton.joints.size() == 0) return single_joint(body);
  report.bone_confidence = grown.skeleton.tree.likelihood;
  TreeSkeleton made = make_skeleton(grown.skeleton.joints, grown.skeleton.tree, body.working.normalization, body.frame.is_seen_from_behind,
                                    grown.skeleton.part);
  PerJoint<std::optional<std::size_t>> from;
  for (std::size_t joint : made.from) from.push_back(grown.skeleton.from[joint]);
  const std::vector<JointEvidence> evidence = joint_evidence(seen, grown.found.joints, body.working.mesh);
  judge_joints(evidence, from, result);
  result.character_evidence =
      are_usual_joints(options) ? evidence_of(grown, evidence) : evidence_of_usual_joints(seen, body, models, options, stages);
  report.character = character_probability(result.character_evidence);
  const auto& sure = report.joint_confidence;
  report.confidence = *report.character * std::accumulate(sure.begin(), sure.end(), 0.0f) / static_cast<float>(sure.size());
  return std::move(made.skeleton);
}

// A character as it was looked at, with one axis up.
struct Seen {
  Body body;
  Skeleton skeleton;  // in its frame
};

Seen look_at(const TriangleMesh& mesh, const infer::RignetModels& models, const RignetOptions& options, RignetResult& result,
             Stages& stages) {
  Seen seen{study(mesh, options, stages), {}};
  seen.skeleton =
      options.skeleton ? turned(*options.skeleton, seen.body.frame.turn) : predict_skeleton(seen.body, models, options, result, stages);
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

// The skeleton's bones in the frame of the networks.
std::vector<Bone> normalised_bones(const Skeleton& skeleton, const geometry::Normalization& normalization) {
  std::vector<Bone> list = bones(skeleton);
  for (Bone& b : list) b.segment = {normalization.apply(b.segment.a), normalization.apply(b.segment.b)};
  return list;
}

Matrix distances_to(const std::vector<Bone>& bones, const Body& body, const Ablation& ablation) {
  std::vector<Segment> segments;
  std::vector<int> starts;
  for (const Bone& b : bones) {
    segments.push_back(b.segment);
    starts.push_back(static_cast<int>(b.start));
  }
  if (!ablation.geodesic) return geometry::straight_distance(body.working.mesh, segments);
  const int count = std::max(ablation.bones, geometry::kSkinBones);
  return geometry::volumetric_geodesic_distance(body.working.mesh, body.voxels, segments, {starts, count});
}

// Whether many joints have hardly a vertex that is nearer to their bones than to all others: fingers, on a mesh that can be finer.
bool is_too_coarse(const std::vector<Bone>& bones, std::size_t joints, const Body& body, const geometry::WorkingMeshOptions& options) {
  if (options.target_vertices >= kFineVertices) return false;
  if (joints < kManyJoints || body.working.clean.mesh.positions.size() <= body.positions().size()) return false;
  std::vector<Segment> segments;
  for (const Bone& b : bones) segments.push_back(b.segment);
  const Matrix distances = geometry::straight_distance(body.working.mesh, segments);
  std::vector<std::size_t> vertices(joints, 0);
  for (Eigen::Index v = 0; v < distances.rows(); ++v) {
    Eigen::Index nearest = 0;
    distances.row(v).minCoeff(&nearest);
    ++vertices[index(bones[static_cast<std::size_t>(nearest)].start)];
  }
  return std::ranges::count_if(vertices, [](std::size_t n) { return n < kFewVertices; }) >= static_cast<std::ptrdiff_t>(kManyJoints);
}

// What the binding network reads of every vertex and the bones near it.
nets::BindArrays choices_of(const Body& body, const geometry::BoneList& bones, const geometry::IndexMatrix& nearest,
                            const Matrix& distances) {
  Matrix of_nearest = Matrix::Zero(nearest.rows(), nearest.cols());
  for (Eigen::Index v = 0; v < nearest.rows(); ++v)
    for (Eigen::Index k = 0; k < nearest.cols(); ++k)
      if (nearest(v, k) >= 0) of_nearest(v, k) = distances(v, nearest(v, k));
  const PerVertex<Vec3f> normals = vertex_normals(body.working.mesh);
  const geometry::BindInputs inputs = geometry::bind_inputs(body.positions(), normals.raw(), bones, nearest, of_nearest);
  nets::BindArrays choices;
  choices.add(inputs.features, inputs.offsets, inputs.bones);
  return choices;
}

Matrix predict_weights(const std::vector<Bone>& bones, std::size_t joints, const Matrix& distances, const Body& body,
                       const infer::RignetModels& models, const Ablation& ablation, std::vector<std::string>& warnings) {
  if (joints == 1) return Matrix::Ones(distances.rows(), 1);
  std::vector<Segment> segments;
  std::vector<std::uint8_t> leaf;
  std::vector<int> starts, ends;
  for (const Bone& b : bones) {
    segments.push_back(b.segment);
    leaf.push_back(b.end ? 0 : 1);
    starts.push_back(static_cast<int>(b.start));
    ends.push_back(b.end ? static_cast<int>(*b.end) : -1);
  }
  const Matrix choice = geometry::one_bone_per_joint(distances, starts);
  geometry::IndexMatrix nearest = geometry::nearest_bones(choice, ablation.bones);
  Matrix weights;
  if (models.binds()) {
    weights = models.bind_weights(body.graph, choices_of(body, {segments, starts, ends}, nearest, choice), ablation.bones);
  } else {
    const geometry::SkinInputs inputs = geometry::skin_inputs(body.positions(), segments, leaf, choice);
    weights = models.skin_weights(body.graph, inputs.features, inputs.nearest);
    nearest = inputs.nearest;
  }
  if (weights.allFinite()) return joint_weights(weights, nearest, bones, joints);
  warnings.push_back("the skin network gave no numbers: weights fall off with the distance to the bones instead");
  return skin::distance_weights(distances, bones, joints);
}

// The binding network's weights and NeuroSkinning's (its own, with geodesic voxel binding in it): they learned the same from different
// evidence, and err in different places.
Matrix heard_beside(const Matrix& raw, const infer::NeuroskinningModel& second, const Skeleton& skeleton, const Body& body, float share,
                    Stages& stages, std::vector<std::string>& warnings) {
  Skeleton placed = skeleton;
  for (Vec3f& p : placed.rest_positions) p = body.working.normalization.apply(p);
  const TriangleMesh& mesh = body.working.mesh;
  const auto near = stages.run("wide neighbourhoods", [&] { return neuroskinning_neighbours(mesh); });
  const auto inputs = stages.run("joint choices", [&] { return neuroskinning_inputs(mesh, body.ring, near, placed, second); });
  return stages.run("second network",
                    [&]() -> Matrix { return pooled(raw, neuroskinning_rows(inputs, second, kGeometricShare, warnings), share); });
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
  out.evidence = evidence(out.joints, body, models, options.ablation);
  out.tree = connect(out.joints, out.evidence, options.tree);
  return out;
}

}  // namespace

RignetResult rig_character(const TriangleMesh& mesh, const infer::RignetModels& models, const RignetOptions& options,
                           const Progress& progress) {
  check(options);
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
  result.skeleton = options.skeleton ? *options.skeleton : turned(skeleton, body.frame.turn.transpose());
  const std::vector<Bone> list = normalised_bones(skeleton, body.working.normalization);
  if (is_too_coarse(list, skeleton.size(), body, options.working_mesh)) study_closer(body, mesh, options.working_mesh, stages);
  const Matrix distances = stages.run("bone distances", [&] { return distances_to(list, body, options.ablation); });
  Matrix raw = stages.run(
      "skin network", [&] { return predict_weights(list, skeleton.size(), distances, body, models, options.ablation, report.warnings); });
  SkinPredictionOptions finish = options.skin;
  if (const auto* second = models.neuroskinning(); second && options.ablation.neuroskinning > 0.0f && skeleton.size() > 1) {
    raw = heard_beside(raw, *second, skeleton, body, options.ablation.neuroskinning, stages, report.warnings);
    finish.smooth = finish.smooth.value_or(0);  // three together are smooth by themselves, and what they call little is little
    finish.prune_share = finish.prune_share.value_or(0.05f);
  }
  result.weights = stages.run("weights", [&] {
    const auto partners = joint_partners(skeleton, body);
    if (partners) raw = mean_with_image(raw, body.working.mesh, *body.symmetry, *partners);
    SkinWeights weights = finish_weights(raw, body.working, body.ring, skeleton, finish);
    if (!partners || !body.pairs) return weights;
    return mirrored_exactly(weights, body.working.clean.from_original, body.pairs->partner, *partners, options.skin.max_influences);
  });
  assess(body, skeleton, distances, options, report);
  return result;
}

ConnectedJoints connect_joints(const TriangleMesh& mesh, std::span<const Vec3f> joints, const infer::RignetModels& models,
                               const RignetOptions& options) {
  check(options);
  ConnectedJoints out = connect_upright(mesh, joints, models, options);
  if (options.up != Up::automatic || geometry::stance(mesh) != geometry::Stance::unclear) return out;
  RignetOptions z_up = options;
  z_up.up = Up::z;
  ConnectedJoints lying = connect_upright(mesh, joints, models, z_up);
  return lying.tree.likelihood > out.tree.likelihood ? lying : out;
}

}  // namespace osteon::pipelines
