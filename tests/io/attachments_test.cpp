// SPDX-License-Identifier: Apache-2.0
// What hung from the joints of a rig that is replaced.
#include "files.h"
#include "osteon/io/gltf/import.h"
#include "osteon/io/save.h"

namespace osteon::io {
namespace {

using namespace osteon::io::test;
using gltf::Json;

constexpr int kHip = 1, kKnee = 2, kSocket = 3, kGrip = 4, kCamera = 5;

Json channel_of(int node, const char* path) { return Json{{"sampler", 0}, {"target", {{"node", node}, {"path", path}}}}; }

Json clip(const char* name, const std::vector<Json>& channels) {
  return Json{{"name", name}, {"samplers", Json::array({Json{{"input", 0}, {"output", 0}}})}, {"channels", channels}};
}

// The skinned tetrahedron with a socket, a grip in it and a camera under its turned and scaled knee, and clips of all of these.
gltf::Document equipped_document() {
  gltf::Document document = skinned_tetrahedron_document();
  Json& nodes = document.json["nodes"];
  nodes[kKnee]["rotation"] = {0, 0, 0.6, 0.8};
  nodes[kKnee]["scale"] = {2, 2, 2};
  nodes[kKnee]["children"] = {kSocket, kCamera};
  nodes.push_back({{"name", "socket"}, {"rotation", {0.6, 0, 0, 0.8}}, {"extras", {{"holds", "lamp"}}}, {"children", {kGrip}}});
  nodes.push_back({{"name", "grip"}, {"translation", {0, 0.5, 0}}});
  nodes.push_back({{"name", "eye"}, {"translation", {-1, 0, 0}}, {"camera", 0}});
  document.json["cameras"] = Json::array({Json::parse(R"({"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.1}})")});
  document.json["animations"] = {clip("kick", {channel_of(kKnee, "rotation"), channel_of(kHip, "translation")}),
                                 clip("aim", {channel_of(kKnee, "rotation"), channel_of(kCamera, "rotation")}),
                                 clip("zoom", {channel_of(kCamera, "translation")})};
  return document;
}

// Two joints near the old ones, with other axes.
Skeleton thigh_and_shin() {
  Skeleton skeleton;
  skeleton.add("thigh", std::nullopt, {0.4f, 0, 0}, Quatf(Eigen::AngleAxisf(0.3f, Vec3f(1, 2, 3).normalized())));
  skeleton.add("shin", JointId{0}, {1.4f, 0.1f, 0.2f}, Quatf(Eigen::AngleAxisf(3.0f, Vec3f::UnitZ())));
  return skeleton;
}

SkinWeights all_to_the_root(std::size_t vertices) {
  SkinWeights weights;
  const Influence whole{JointId{0}, 1.0f};
  for (std::size_t v = 0; v < vertices; ++v) weights.append({&whole, 1});
  return weights;
}

struct Replaced {
  gltf::Document document;
  std::vector<std::string> changes;
};

Replaced replaced_rig(const gltf::Document& in, const LoadOptions& options = {}) {
  const TemporaryFolder folder;
  const Asset asset = load(write_document(folder / "in.glb", in), options);
  auto changes = save_glb(folder / "out.glb", asset, thigh_and_shin(), all_to_the_root(asset.mesh.positions.size()));
  return {read_document(folder / "out.glb"), std::move(changes)};
}

Scene::Node node_named(const gltf::Document& document, const std::string& name) {
  std::vector<std::string> repairs;
  Scene scene = gltf::import_scene(document, repairs).scene;
  const auto found = std::ranges::find(scene.nodes, name, &Scene::Node::name);
  return found == scene.nodes.end() ? Scene::Node{"no " + name, {}, {}} : *found;
}

std::vector<std::string> names_above(const gltf::Document& document, const std::string& name) {
  std::vector<std::string> out;
  for (auto n = node_named(document, name).parent; n;) {
    out.push_back(document.json["nodes"][*n].value("name", ""));
    n = node_named(document, out.back()).parent;
  }
  return out;
}

void expect_same_place(const Eigen::Affine3d& a, const Eigen::Affine3d& b) {
  EXPECT_LT((a.matrix() - b.matrix()).cwiseAbs().maxCoeff(), 1e-6);
}

TEST(Attachments, hang_under_the_nearest_new_joint_where_they_were) {
  const gltf::Document before = equipped_document();
  const Replaced after = replaced_rig(before);
  for (const char* name : {"socket", "grip", "eye"})
    expect_same_place(node_named(after.document, name).world, node_named(before, name).world);
  EXPECT_EQ(names_above(after.document, "grip"), (std::vector<std::string>{"socket", "knee attachments", "shin", "thigh"}));
  EXPECT_EQ(names_above(after.document, "eye"), (std::vector<std::string>{"knee attachments", "shin", "thigh"}));
  EXPECT_TRUE(has_repair(after.changes, "carried under the nearest new ones: 'socket' (now under 'shin'), 'eye' (now under 'shin')"));
  EXPECT_TRUE(has_repair(after.changes, "replaced the rig that the asset had (2 joints)"));
}

TEST(Attachments, keep_their_own_nodes_as_they_were) {
  const Json before = equipped_document().json["nodes"], after = replaced_rig(equipped_document()).document.json["nodes"];
  for (const int n : {kSocket, kGrip, kCamera}) {
    const auto same = std::ranges::find_if(after, [&](const Json& node) { return node["name"] == before[n]["name"]; });
    ASSERT_NE(same, after.end());
    for (const char* key : {"translation", "rotation", "extras", "camera"})
      EXPECT_EQ(same->value(key, Json()), before[n].value(key, Json()));
  }
  EXPECT_EQ(std::ranges::count_if(after, [](const Json& node) { return node["name"] == "knee" || node["name"] == "hip"; }), 0);
}

TEST(Attachments, keep_the_clips_that_move_them_and_lost_ones_are_named) {
  const Replaced after = replaced_rig(equipped_document());
  const Json& clips = after.document.json["animations"];
  ASSERT_EQ(clips.size(), 2u);
  EXPECT_EQ(clips[0]["name"], "aim");
  EXPECT_EQ(clips[0]["channels"].size(), 1u);
  EXPECT_EQ(clips[1]["name"], "zoom");
  for (const Json& kept : clips)
    EXPECT_EQ(after.document.json["nodes"][kept["channels"][0]["target"]["node"].get<std::size_t>()]["name"], "eye");
  EXPECT_TRUE(has_repair(after.changes, "removed animations that moved only what the new rig moves now: 'kick'"));
  EXPECT_TRUE(has_repair(after.changes, "removed from animations what the new rig moves now: 'aim'"));
}

TEST(Attachments, come_along_where_the_file_is_scaled) {
  const Replaced after = replaced_rig(equipped_document(), {.up = {}, .scale = 0.5f});
  expect_same_place(node_named(after.document, "grip").world, Eigen::Scaling(0.5) * node_named(equipped_document(), "grip").world);
}

TEST(Attachments, hang_under_the_joints_of_another_file_too) {
  const TemporaryFolder folder;
  const gltf::Document before = equipped_document();
  const Asset asset = load(write_document(folder / "in.glb", before));
  save_glb(folder / "other.glb", asset, thigh_and_shin(), all_to_the_root(4));
  const Eigen::Affine3d fit(Eigen::Translation3d(0.05, 0, 0));
  save_glb(folder / "out.glb", asset, load_skeleton_file(folder / "other.glb"), fit, all_to_the_root(4));
  const gltf::Document after = read_document(folder / "out.glb");
  const Scene::Node eye = node_named(after, "eye");
  expect_same_place(eye.world, node_named(before, "eye").world);
}

TEST(Attachments, a_joint_that_shows_something_goes_on_as_a_node_without_its_clips) {
  gltf::Document before = skinned_tetrahedron_document();
  before.json["extensionsUsed"].push_back("KHR_lights_punctual");
  before.json["nodes"][kHip]["extensions"] = {{"KHR_lights_punctual", {{"light", 0}}}};
  before.json["animations"] = Json::array({clip("sway", {channel_of(kHip, "rotation")})});
  const Replaced after = replaced_rig(before);
  expect_same_place(node_named(after.document, "hip").world, node_named(before, "hip").world);
  EXPECT_EQ(names_above(after.document, "hip"), (std::vector<std::string>{"attachments", "thigh"}));
  EXPECT_FALSE(after.document.json.contains("animations"));
  EXPECT_TRUE(has_repair(after.changes, "(2 joints)"));
}

TEST(Attachments, end_bones_of_the_skin_are_joints) {
  gltf::Document before = skinned_tetrahedron_document();
  const Replaced after = replaced_rig(before);
  EXPECT_EQ(after.document.json["nodes"].size(), 3u);
  EXPECT_THAT(after.changes, testing::ElementsAre("replaced the rig that the asset had (2 joints)"));
}

TEST(Attachments, joints_of_a_skin_that_stays_keep_their_place) {
  gltf::Document before = equipped_document();
  before.json["skins"].push_back({{"joints", {kGrip}}});
  before.json["nodes"].push_back({{"name", "spare"}, {"mesh", 0}, {"skin", 1}});
  before.json["scenes"].push_back({{"nodes", {6}}});
  const Replaced after = replaced_rig(before);
  EXPECT_EQ(names_above(after.document, "grip"), (std::vector<std::string>{"socket", "knee", "hip"}));
  EXPECT_EQ(names_above(after.document, "eye"), (std::vector<std::string>{"knee attachments", "shin", "thigh"}));
}

}  // namespace
}  // namespace osteon::io
