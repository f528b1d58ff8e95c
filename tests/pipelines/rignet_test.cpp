// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/rignet.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "figure_with_hands.h"
#include "osteon/base/parallel.h"
#include "osteon/geometry/mirror_pairs.h"
#include "osteon/mesh/shapes.h"
#include "osteon/pipelines/hands.h"
#include "osteon/rig/rig.h"
#include "osteon/synth/character.h"
#include "untrained.h"

namespace osteon::pipelines {
namespace {

using test::Network;
using testing::HasSubstr;

// Networks that were never trained: whatever they say, the rig has to be valid.
const infer::RignetModels& untrained() {
  static const infer::RignetModels models = test::untrained_models({Network::votes, Network::tree, Network::bind});
  return models;
}

// Networks that leave every vote in the middle of the body: there are joints on the plane of symmetry.
const infer::RignetModels& silent() {
  static const infer::RignetModels models = test::untrained_models({Network::votes, Network::tree, Network::bind}, test::LastLayer::zero);
  return models;
}

TriangleMesh placed(const TriangleMesh& mesh, const Vec3f& at, float turn_z) {
  return shapes::transformed(mesh, Eigen::Translation3f(at) * Transform(Eigen::AngleAxisf(turn_z, Vec3f::UnitZ())));
}

// Trunk, head, two legs, two arms: five overlapping parts, in centimetres and away from the origin.
TriangleMesh figure() {
  TriangleMesh mesh = placed(shapes::capsule(0.13f, 0.45f), {0, 0.85f, 0}, 0.0f);
  mesh = shapes::merged(mesh, placed(shapes::icosphere(2, 0.15f), {0, 1.6f, 0.02f}, 0.0f));
  for (float side : {1.0f, -1.0f}) {
    mesh = shapes::merged(mesh, placed(shapes::capsule(0.07f, 0.75f), {side * 0.1f, 0.07f, 0}, 0.0f));
    mesh = shapes::merged(mesh, placed(shapes::capsule(0.05f, 0.6f), {side * 0.12f, 1.3f, 0}, -side * 1.5f));
  }
  return shapes::transformed(mesh, Transform(Eigen::Translation3f(10, -4, 20) * Eigen::Scaling(100.0f)));
}

const RignetResult& rigged_figure() {
  static const RignetResult result = rig_character(figure(), untrained());
  return result;
}

void expect_usable(const TriangleMesh& mesh, const RignetResult& result) {
  validate(Rig{mesh, result.skeleton, result.weights});
  const RigReport& report = result.report;
  EXPECT_GE(report.confidence, 0.0f);
  EXPECT_LE(report.confidence, 1.0f);
  EXPECT_EQ(report.joints, result.skeleton.size());
  EXPECT_EQ(report.vertices, mesh.positions.size());
  EXPECT_FALSE(report.stages.empty());
}

Skeleton straight(const TriangleMesh& mesh) {
  Skeleton skeleton;
  const auto box = bounds(mesh);
  const Vec3f middle = box.center();
  const JointId low = skeleton.add("low", std::nullopt, {middle.x(), box.min().y(), middle.z()});
  skeleton.add("high", skeleton.add("mid", low, middle), {middle.x(), box.max().y(), middle.z()});
  return skeleton;
}

TEST(RigCharacter, untrained_networks_still_give_a_valid_rig) {
  expect_usable(figure(), rigged_figure());
  EXPECT_TRUE(rigged_figure().report.symmetry_error.has_value());
  EXPECT_LE(rigged_figure().weights.max_influences(), 4u);
}

TEST(RigCharacter, joints_lie_in_the_world_of_the_mesh) {
  auto box = bounds(figure());
  const Vec3f voxel = 0.02f * Vec3f::Constant(box.sizes().maxCoeff());  // those of the surface count as inside
  box = {box.min() - voxel, box.max() + voxel};
  for (const Vec3f& p : rigged_figure().skeleton.rest_positions) EXPECT_TRUE(box.contains(p)) << p.transpose();
}

TEST(RigCharacter, any_number_of_threads_gives_the_same_rig) {
  const int before = threads();
  for (int n : {1, 3}) {
    set_threads(n);
    const RignetResult result = rig_character(figure(), untrained());
    EXPECT_EQ(result.skeleton.names, rigged_figure().skeleton.names);
    EXPECT_EQ(result.skeleton.rest_positions, rigged_figure().skeleton.rest_positions);
    EXPECT_EQ(result.weights, rigged_figure().weights);
  }
  set_threads(before);
}

TEST(RigCharacter, renumbered_vertices_and_faces_give_the_same_rig) {
  const TriangleMesh mesh = figure();
  Random random(5);
  std::vector<VertexId> new_place(mesh.positions.size());
  for (std::size_t i = 0; i < new_place.size(); ++i) new_place[i] = static_cast<VertexId>(i);
  random.shuffle(std::span(new_place));
  TriangleMesh other = mesh;
  for (VertexId v : mesh.positions.ids()) other.positions[new_place[index(v)]] = mesh.positions[v];
  random.shuffle(std::span(other.faces.raw()));
  for (Triangle& t : other.faces)
    for (VertexId& v : t) v = new_place[index(v)];
  const RignetResult &a = rigged_figure(), b = rig_character(other, untrained());
  EXPECT_EQ(a.skeleton.names, b.skeleton.names);
  EXPECT_EQ(a.skeleton.parents, b.skeleton.parents);
  EXPECT_EQ(a.skeleton.rest_positions, b.skeleton.rest_positions);
  for (VertexId v : mesh.positions.ids()) EXPECT_TRUE(std::ranges::equal(a.weights[v], b.weights[new_place[index(v)]])) << index(v);
}

Eigen::Matrix3f by_columns(const Vec3f& x, const Vec3f& y, const Vec3f& z) {
  Eigen::Matrix3f out;
  out << x, y, z;
  return out;
}

TEST(RigCharacter, a_turned_mesh_gets_the_same_rig_turned) {
  // On the ground, with a face. Around the vertical axis and on the plane z = 0.
  const TriangleMesh mesh = shapes::merged(placed(figure(), {-10, 5, -20}, 0.0f), placed(shapes::icosphere(3, 5), {0, 165, 15}, 0.0f));
  const geometry::WorkingMeshOptions small{.target_vertices = 500, .min_vertices = 400};
  const RignetResult straight = rig_character(mesh, untrained(), {.working_mesh = small});
  const Vec3f x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  for (const Eigen::Matrix3f& turn : {by_columns(-z, y, x), by_columns(-x, y, -z), by_columns(z, y, -x), by_columns(x, z, -y)}) {
    const RignetResult result = rig_character(turned(mesh, turn), untrained(), {.working_mesh = small});
    EXPECT_EQ(result.skeleton.names, straight.skeleton.names);
    EXPECT_EQ(result.skeleton.parents, straight.skeleton.parents);
    EXPECT_EQ(result.weights, straight.weights);
    EXPECT_EQ(result.report.up == 'z', turn * y == z);
    for (JointId j : result.skeleton.names.ids()) {
      EXPECT_EQ(result.skeleton.rest_positions[j], turn * straight.skeleton.rest_positions[j]);
      const Quatf expected = Quatf(turn) * straight.skeleton.rest_orientations[j];
      EXPECT_LT(result.skeleton.rest_orientations[j].angularDistance(expected), 1e-3f);
    }
  }
}

// Joint -> the joint in whose place its mirror image is, to within `tolerance`.
PerJoint<JointId> images(const Skeleton& skeleton, const Plane& plane, float tolerance) {
  PerJoint<JointId> out;
  const auto joints = skeleton.names.ids();
  for (const Vec3f& p : skeleton.rest_positions) {
    const auto distance = [&](JointId j) { return (skeleton.rest_positions[j] - plane.mirror(p)).norm(); };
    const JointId image = *std::ranges::min_element(joints, {}, distance);
    EXPECT_LE(distance(image), tolerance);
    out.push_back(image);
  }
  return out;
}

std::string other_side(std::string name) {
  for (const auto& [here, there] : {std::pair("left", "right"), std::pair("right", "left")})
    if (name.starts_with(here)) return there + name.substr(std::string_view(here).size());
  return name;
}

float weight(const SkinWeights& weights, VertexId v, JointId j) {
  for (const Influence& i : weights[v])
    if (i.joint == j) return i.weight;
  return 0.0f;
}

// A character and, for every vertex, its mirror image across x = 0; images to the last bit.
struct Symmetric {
  TriangleMesh mesh;
  PerVertex<VertexId> image;

  explicit Symmetric(synth::Kind kind) {
    mesh = synth::make_character(kind, 1, {.cells = 48, .finish = synth::Finish::Smooth}).mesh;
    const geometry::CleanMesh clean = geometry::clean(mesh);
    TriangleMesh unit = clean.mesh;
    const geometry::Normalization frame = geometry::normalization_of(unit);
    for (Vec3f& p : unit.positions) p = frame.apply(p);
    const auto pairs = geometry::mirror_pairs(unit, {Vec3f::UnitX(), 0.0f});
    if (!pairs) throw Error("not symmetric");
    PerVertex<VertexId> someone(unit.positions.size());
    for (VertexId v : mesh.positions.ids()) someone[clean.from_original[v]] = v;
    for (VertexId v : mesh.positions.ids()) {
      const VertexId here = clean.from_original[v], there = pairs->partner[here];
      const Vec3f& p = clean.mesh.positions[std::min(here, there)];
      mesh.positions[v] = here == there ? Vec3f(0, p.y(), p.z()) : here < there ? p : Vec3f(-p.x(), p.y(), p.z());
      image.push_back(someone[there]);
    }
  }
};

// `there` is the plane of the mesh where it is now.
void expect_symmetric_rig(const TriangleMesh& at_place, const PerVertex<VertexId>& image, const Plane& there, float tolerance) {
  const RignetResult result =
      rig_character(at_place, silent(), {.working_mesh = geometry::WorkingMeshOptions{.target_vertices = 500, .min_vertices = 400}});
  validate(Rig{at_place, result.skeleton, result.weights});
  const auto partner = images(result.skeleton, there, tolerance);
  for (JointId j : partner.ids()) {
    EXPECT_EQ(partner[partner[j]], j);
    EXPECT_EQ(result.skeleton.names[partner[j]], other_side(result.skeleton.names[j]));
    if (result.skeleton.parents[j]) {
      EXPECT_EQ(result.skeleton.parents[partner[j]], partner[*result.skeleton.parents[j]]);
    }
  }
  int unequal = 0;
  for (VertexId v : image.ids())
    for (JointId j : partner.ids()) unequal += weight(result.weights, v, j) != weight(result.weights, image[v], partner[j]);
  EXPECT_EQ(unequal, 0);
}

TEST(RigCharacter, a_mesh_that_is_its_own_mirror_image_gets_such_a_rig) {
  const Transform place = Eigen::Translation3f(3, 1, -2) * Transform(Eigen::AngleAxisf(0.7f, Vec3f::UnitY())) * Eigen::Scaling(1.7f);
  const Vec3f normal = (place.linear() * Vec3f::UnitX()).normalized();
  const Plane there{normal, normal.dot(place.translation())};
  for (const synth::Kind kind : {synth::Kind::Biped, synth::Kind::Spider, synth::Kind::Robot, synth::Kind::BlockyHumanoid}) {
    SCOPED_TRACE(synth::name(kind));
    const Symmetric character(kind);
    expect_symmetric_rig(character.mesh, character.image, {Vec3f::UnitX(), 0.0f}, 0.0f);
    const TriangleMesh elsewhere = shapes::transformed(character.mesh, place);
    expect_symmetric_rig(elsewhere, character.image, there, 1e-5f * bounds(elsewhere).sizes().maxCoeff());
  }
}

TEST(RigCharacter, a_given_skeleton_is_kept_and_skinned) {
  const TriangleMesh mesh = figure();
  const Skeleton skeleton = straight(mesh);
  const RignetResult result = rig_character(mesh, untrained(), {.skeleton = skeleton, .skin = {.max_influences = 2}});
  expect_usable(mesh, result);
  EXPECT_EQ(result.skeleton.names, skeleton.names);
  EXPECT_EQ(result.skeleton.rest_positions, skeleton.rest_positions);
  EXPECT_LE(result.weights.max_influences(), 2u);
  EXPECT_TRUE(result.report.joint_confidence.empty());
  EXPECT_EQ(result.report.confidence, result.report.coverage);
}

TEST(RigCharacter, joints_finer_than_the_working_mesh_are_skinned_on_a_finer_one) {
  const test::FigureWithHands figure = test::figure_with_hands(4, 1, 200);
  ASSERT_GE(figure.skeleton.size(), 40u);
  Skeleton coarse;  // without hands
  for (JointId j : figure.skeleton.names.ids()) {
    const std::string& name = figure.skeleton.names[j];
    if (name.find("Hand") != std::string::npos) continue;
    const auto parent = figure.skeleton.parents[j];
    const auto& names = coarse.names.raw();
    coarse.add(name,
               parent ? std::optional(
                            JointId(static_cast<std::uint16_t>(std::ranges::find(names, figure.skeleton.names[*parent]) - names.begin())))
                      : std::nullopt,
               figure.skeleton.rest_positions[j]);
  }
  const auto working_meshes = [&](const Skeleton& skeleton) {
    const RignetResult result = rig_character(figure.mesh, untrained(), {.skeleton = skeleton});
    expect_usable(figure.mesh, result);
    return std::ranges::count(result.report.stages, "working mesh", &StageTime::stage);
  };
  EXPECT_EQ(working_meshes(figure.skeleton), working_meshes(coarse) + 1);
}

TEST(RigCharacter, every_joint_has_a_confidence) {
  const RignetResult& result = rigged_figure();
  ASSERT_EQ(result.report.joint_confidence.size(), result.skeleton.size());
  for (std::size_t j = 0; j < result.joint_evidence.size(); ++j)
    EXPECT_EQ(result.report.joint_confidence[j], result.joint_evidence[j] ? joint_confidence(*result.joint_evidence[j]) : kHandConfidence);
  EXPECT_EQ(result.report.character, character_probability(result.character_evidence));
  EXPECT_LE(result.report.confidence, *result.report.character);
}

TEST(RigCharacter, parts_can_be_left_out_and_the_rig_is_still_valid) {
  const TriangleMesh mesh = figure();
  for (const Ablation& without : {Ablation{.attention = false}, Ablation{.views = false}, Ablation{.bone_network = false},
                                  Ablation{.geodesic = false}, Ablation{.bones = 1}})
    expect_usable(mesh, rig_character(mesh, untrained(), {.ablation = without}));
}

TEST(ConnectJoints, makes_a_tree_of_the_joints_in_their_order) {
  const Skeleton skeleton = straight(figure());
  const ConnectedJoints connected = connect_joints(figure(), skeleton.rest_positions.raw(), untrained());
  EXPECT_EQ(connected.joints.size(), 3u);
  const auto& parents = connected.tree.parents;
  EXPECT_EQ(std::ranges::count_if(parents, [](const auto& parent) { return !parent; }), 1);
  EXPECT_FALSE(parents[connected.tree.root].has_value());
}

TEST(ConnectJoints, without_the_network_the_nearest_joints_are_joined) {
  const Skeleton skeleton = straight(figure());
  const auto connected = connect_joints(figure(), skeleton.rest_positions.raw(), untrained(), {.ablation = {.bone_network = false}});
  const auto joined = [&](std::size_t a, std::size_t b) { return connected.tree.parents[a] == b || connected.tree.parents[b] == a; };
  EXPECT_TRUE(joined(0, 1));
  EXPECT_TRUE(joined(1, 2));
}

TEST(ConnectJoints, around_the_origin_the_likelier_tree_of_both_up_axes_is_it) {
  const Vec3f middle = bounds(figure()).center();
  const TriangleMesh mesh = shapes::transformed(figure(), Transform(Eigen::Translation3f(-middle)));
  Skeleton skeleton = straight(mesh);
  skeleton.add("side", JointId{0}, {40, 30, 5});
  const auto tree_of = [&](Up up) { return connect_joints(mesh, skeleton.rest_positions.raw(), untrained(), {.up = up}).tree; };
  const JointTree y = tree_of(Up::y), z = tree_of(Up::z), found = tree_of(Up::automatic);
  ASSERT_NE(y.likelihood, z.likelihood);
  const JointTree& likelier = y.likelihood > z.likelihood ? y : z;
  EXPECT_EQ(found.likelihood, likelier.likelihood);
  EXPECT_EQ(found.root, likelier.root);
  EXPECT_EQ(found.parents, likelier.parents);
}

TEST(RigCharacter, shapes_that_are_no_characters_get_a_valid_rig_too) {
  const std::pair<const char*, TriangleMesh> meshes[] = {
      {"cube", shapes::box({1, 1, 1})},
      {"sheet", shapes::sheet(9, 9)},
      {"sphere", shapes::icosphere(3, 1e-3f)},
      {"one face",
       [] {
         TriangleMesh m;
         for (const Vec3f& p : {Vec3f(0, 0, 0), Vec3f(1, 0, 0), Vec3f(0, 1, 0)}) m.positions.push_back(p);
         m.faces.push_back({VertexId{0}, VertexId{1}, VertexId{2}});
         return m;
       }()},
      {"far pieces", shapes::merged(shapes::icosphere(1), placed(shapes::icosphere(1), {50, 0, 0}, 0.0f))}};
  for (const auto& [name, mesh] : meshes) {
    SCOPED_TRACE(name);
    const geometry::WorkingMeshOptions small{.target_vertices = 300, .min_vertices = 200};  // enough here, and soon done
    expect_usable(mesh, rig_character(mesh, untrained(), {.working_mesh = small}));
    expect_usable(mesh, rig_character(mesh, untrained(), {.symmetry = Symmetry::off, .working_mesh = small}));
  }
}

TEST(RigCharacter, says_that_two_characters_side_by_side_are_rigged_as_one) {
  const RignetResult result = rig_character(shapes::merged(figure(), shapes::shifted(figure(), {400, 0, 0})), untrained());
  EXPECT_THAT(result.report.warnings, testing::Contains(HasSubstr("one by one")));
  EXPECT_THAT(rigged_figure().report.warnings, Not(testing::Contains(HasSubstr("one by one"))));
}

TEST(RigCharacter, what_is_beside_the_character_follows_the_root_and_changes_nothing_else) {
  const TriangleMesh ground = shapes::transformed(shapes::box({900, 1, 900}), Transform(Eigen::Translation3f(10, -4.5f, 20)));
  const TriangleMesh beside = shapes::merged(ground, shapes::shifted(shapes::icosphere(0, 1), {5000, 100, 0}));
  const TriangleMesh mesh = shapes::merged(beside, figure());
  const RignetResult result = rig_character(mesh, untrained());
  expect_usable(mesh, result);
  EXPECT_THAT(result.report.warnings, testing::Contains(HasSubstr("20 of")));
  EXPECT_EQ(result.skeleton.names, rigged_figure().skeleton.names);
  EXPECT_EQ(result.skeleton.rest_positions, rigged_figure().skeleton.rest_positions);
  const Influence root{JointId(0), 1.0f};
  const auto same = [](const Influence& a, const Influence& b) { return a.joint == b.joint && std::abs(a.weight - b.weight) < 1e-6f; };
  for (VertexId v : mesh.positions.ids()) {
    const std::size_t first = beside.positions.size();  // of the figure's vertices
    const auto expected = index(v) < first ? std::span(&root, 1) : rigged_figure().weights[static_cast<VertexId>(index(v) - first)];
    EXPECT_TRUE(std::ranges::equal(result.weights[v], expected, same)) << index(v);
  }
}

TEST(RigCharacter, options_out_of_range_are_named) {
  const TriangleMesh mesh = figure();
  EXPECT_THAT(test::error_of([&] { rig_character(mesh, untrained(), {.bandwidth = 0.5f}); }), HasSubstr("bandwidth: 0.5 found"));
  EXPECT_THAT(test::error_of([&] { rig_character(mesh, untrained(), {.detail = 2.0f}); }), HasSubstr("detail: 2 found"));
  EXPECT_THAT(test::error_of([&] { rig_character(mesh, untrained(), {.joints = 0}); }), HasSubstr("joints: 0 found"));
  EXPECT_THAT(test::error_of([&] { rig_character(mesh, untrained(), {.ablation = {.bones = 9}}); }),
              HasSubstr("bones of a vertex: 9 found"));
  EXPECT_THAT(test::error_of([&] { rig_character(mesh, untrained(), {.skeleton = Skeleton{}}); }), HasSubstr("no joints"));
}

TEST(RigCharacter, progress_rises_and_may_cancel) {
  const TriangleMesh mesh = figure();
  double last = -1.0;
  rig_character(mesh, untrained(), {.skeleton = straight(mesh)}, [&](std::string_view, double done) {
    EXPECT_GT(done, last);
    EXPECT_LT(done, 1.0);
    last = done;
  });
  EXPECT_GT(last, 0.0);
  EXPECT_THROW(rig_character(mesh, untrained(), {},
                             [](std::string_view stage, double) {
                               if (stage == "voxels") throw Cancelled();
                             }),
               Cancelled);
}

}  // namespace
}  // namespace osteon::pipelines
