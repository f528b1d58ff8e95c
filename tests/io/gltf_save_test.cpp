// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/save.h"

#include "files.h"
#include "osteon/io/gltf/skin_attributes.h"
#include "osteon/mesh/shapes.h"
#include "osteon/rig/rig.h"

namespace osteon::io {
namespace {

using namespace osteon::io::test;
using gltf::Json;

// Three joints up the y axis, each with its own axes.
Skeleton chain() {
  Skeleton skeleton;
  skeleton.add("root", std::nullopt, {0.1f, 0, 0}, Quatf(Eigen::AngleAxisf(0.3f, Vec3f(1, 2, 3).normalized())));
  skeleton.add("spine", JointId{0}, {0, 0.5f, 0.2f}, Quatf(Eigen::AngleAxisf(1e-4f, Vec3f::UnitX())));
  skeleton.add("head", JointId{1}, {0, 1, 0}, Quatf(Eigen::AngleAxisf(3.0f, Vec3f::UnitZ())));
  return skeleton;
}

// Weights that all differ: of every vertex for every joint.
SkinWeights spread_weights(std::size_t vertices, std::size_t joints) {
  SkinWeights weights;
  for (std::size_t v = 0; v < vertices; ++v) {
    std::vector<Influence> row;
    for (std::size_t j = 0; j < joints; ++j) row.push_back({static_cast<JointId>(j), 1.0f + static_cast<float>((7 * v + 13 * j) % 11)});
    weights.append(row);
  }
  return weights;
}

struct Saved {
  Asset asset;
  gltf::Document document;
  std::vector<std::string> changes;
};

Saved save_and_load(const Asset& asset, const Skeleton& skeleton, const SkinWeights& weights, const SaveOptions& options = {}) {
  const TemporaryFolder folder;
  const auto path = folder / "out.glb";
  auto changes = save_glb(path, asset, skeleton, weights, options);
  return {load(path), read_document(path), std::move(changes)};
}

Saved rig_and_load(const gltf::Document& document, const SaveOptions& options = {}) {
  const TemporaryFolder folder;
  const Asset asset = load(write_document(folder / "in.glb", document));
  return save_and_load(asset, chain(), spread_weights(asset.mesh.positions.size(), 3), options);
}

void expect_same_skeleton(const Skeleton& a, const Skeleton& b) {
  EXPECT_EQ(a.names, b.names);
  EXPECT_EQ(a.parents, b.parents);
  for (const JointId j : a.names.ids()) {
    EXPECT_VEC3_NEAR(a.rest_positions[j], b.rest_positions[j], 1e-6f);
    EXPECT_LT(a.rest_orientations[j].angularDistance(b.rest_orientations[j]), 1e-6f);
  }
}

void expect_same_weights(const SkinWeights& a, const SkinWeights& b, float tolerance) {
  ASSERT_EQ(a.size(), b.size());
  for (const VertexId v : ids<VertexId>(a.size()))
    for (const Influence& i : a[v]) {
      float found = 0.0f;
      for (const Influence& k : b[v])
        if (k.joint == i.joint) found = k.weight;
      EXPECT_NEAR(found, i.weight, tolerance) << "vertex " << index(v);
    }
}

std::vector<float> floats_of(const gltf::Document& document, const Json& accessor) {
  return gltf::Accessor(document, accessor.get<std::size_t>()).floats();
}

// A document ----------------------------------------------------------------------------------------------------------------------------

TEST(SaveGlb, mesh_skeleton_and_weights_come_back) {
  const Saved saved = rig_and_load(tetrahedron_document());
  EXPECT_EQ(saved.asset.mesh.positions.raw(), kCorners);
  EXPECT_EQ(saved.asset.mesh.faces.size(), 4u);
  expect_same_skeleton(*saved.asset.skeleton, chain());
  expect_same_weights(*saved.asset.weights, spread_weights(4, 3), 1e-6f);
  EXPECT_THAT(saved.changes, testing::IsEmpty());
  EXPECT_THAT(saved.asset.repairs, testing::IsEmpty());
}

TEST(SaveGlb, what_is_not_of_the_rig_stays_as_it_was) {
  const gltf::Document before = tetrahedron_document();
  const Json after = rig_and_load(before).document.json;
  for (const char* key : {"asset", "extensionsUsed", "materials", "textures", "samplers", "images"})
    EXPECT_EQ(after[key].dump(), before.json[key].dump());
  for (std::size_t i = 0; i < before.json["accessors"].size(); ++i)
    EXPECT_EQ(after["accessors"][i].dump(), before.json["accessors"][i].dump());
  for (std::size_t i = 0; i < before.json["bufferViews"].size(); ++i)
    EXPECT_EQ(after["bufferViews"][i].dump(), before.json["bufferViews"][i].dump());
  EXPECT_EQ(after["meshes"][0]["extras"].dump(), before.json["meshes"][0]["extras"].dump());
  EXPECT_EQ(after["meshes"][0]["primitives"][0]["extras"].dump(), R"({"part":1})");
  EXPECT_EQ(after["nodes"][0]["extras"].dump(), R"({"hidden":false})");
  EXPECT_EQ(after["scenes"][0]["name"], "stage");
}

TEST(SaveGlb, the_bytes_that_came_in_go_out_first) {
  const gltf::Document before = tetrahedron_document();
  const Bytes after = rig_and_load(before).document.buffers[0];
  ASSERT_GT(after.size(), before.buffers[0].size());
  EXPECT_TRUE(std::equal(before.buffers[0].begin(), before.buffers[0].end(), after.begin()));
}

TEST(SaveGlb, the_same_rig_gives_the_same_bytes) {
  const TemporaryFolder folder;
  const Asset asset = load(write_document(folder / "in.glb", tetrahedron_document()));
  for (const char* name : {"a.glb", "b.glb"}) save_glb(folder / name, asset, chain(), spread_weights(4, 3));
  EXPECT_EQ(read(folder / "a.glb"), read(folder / "b.glb"));
}

TEST(SaveGlb, joints_and_mesh_stand_at_the_top_of_the_scene) {
  const Json json = rig_and_load(tetrahedron_document()).document.json;
  EXPECT_EQ(json["scenes"][0]["nodes"].dump(), "[0,1]");
  EXPECT_EQ(json["nodes"][0]["skin"], 0);
  EXPECT_EQ(json["nodes"][1]["name"], "root");
  EXPECT_EQ(json["skins"][0]["skeleton"], 1);
  EXPECT_EQ(json["skins"][0]["joints"].dump(), "[1,2,3]");
}

TEST(SaveGlb, the_transform_above_a_mesh_moves_into_the_inverse_bind_matrices) {
  gltf::Document document = tetrahedron_document();
  document.json["nodes"][0]["translation"] = {1, 2, 3};
  document.json["nodes"].push_back(
      {{"name", "turn"}, {"children", {0}}, {"scale", {2, 2, 2}}, {"rotation", {0, 0.70710678, 0, 0.70710678}}});
  document.json["scenes"][0]["nodes"] = {1};
  const TemporaryFolder folder;
  const Asset before = load(write_document(folder / "in.glb", document));
  const Saved saved = save_and_load(before, chain(), spread_weights(4, 3));
  for (const VertexId v : before.mesh.positions.ids()) EXPECT_VEC3_NEAR(saved.asset.mesh.positions[v], before.mesh.positions[v], 2e-6f);
  const Json& json = saved.document.json;
  EXPECT_EQ(json["nodes"].size(), 4u) << "the node above holds nothing any more";
  EXPECT_EQ(json["nodes"][0].dump(), R"({"name":"body","mesh":0,"extras":{"hidden":false},"skin":0})");
  EXPECT_EQ(floats_of(saved.document, json["meshes"][0]["primitives"][0]["attributes"]["POSITION"])[3], 1.0f) << "as it came";
}

TEST(SaveGlb, bake_rewrites_vertices_and_normals_in_world_space) {
  gltf::Document document = tetrahedron_document();
  document.json["nodes"][0]["rotation"] = {0, 0.70710678, 0, 0.70710678};  // x -> -z
  const Saved saved = rig_and_load(document, {.vertices = Vertices::bake});
  const Json& attributes = saved.document.json["meshes"][0]["primitives"][0]["attributes"];
  EXPECT_VEC3_NEAR(Vec3f(floats_of(saved.document, attributes["POSITION"]).data() + 3), Vec3f(0, 0, -1), 1e-6f);
  EXPECT_VEC3_NEAR(Vec3f(floats_of(saved.document, attributes["NORMAL"]).data() + 3), Vec3f(0, 0, -1), 1e-6f);
}

TEST(SaveGlb, a_mirrored_mesh_is_rewritten_with_its_outside_outside) {
  gltf::Document document = tetrahedron_document();
  document.json["nodes"][0]["scale"] = {-1, 1, 2};
  const TemporaryFolder folder;
  const Asset before = load(write_document(folder / "in.glb", document));
  const Saved saved = save_and_load(before, chain(), spread_weights(4, 3));
  EXPECT_EQ(saved.asset.mesh.positions, before.mesh.positions);
  EXPECT_EQ(saved.asset.mesh.faces, before.mesh.faces);
  const auto normals = floats_of(saved.document, saved.document.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"]);
  EXPECT_VEC3_NEAR(Vec3f(normals.data() + 3), Vec3f(-1, 0, 0), 1e-6f);
}

TEST(SaveGlb, morph_targets_are_rewritten_with_their_mesh) {
  gltf::Document document = tetrahedron_document();
  gltf::Writer writer(document);
  const std::vector<Vec3f> change{{1, 0, 0}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
  document.json["meshes"][0]["primitives"][0]["targets"] = Json::array({Json{{"POSITION", writer.positions(change)}}});
  document.json["nodes"][0]["scale"] = {1, 2, 3};
  document.json["nodes"][0]["rotation"] = {0, 0, 0.70710678, 0.70710678};  // x -> y
  const Saved saved = rig_and_load(document);
  const Json& target = saved.document.json["meshes"][0]["primitives"][0]["targets"][0];
  EXPECT_VEC3_NEAR(Vec3f(floats_of(saved.document, target["POSITION"]).data()), Vec3f(0, 1, 0), 1e-6f);
}

TEST(SaveGlb, a_mesh_shown_twice_gets_weights_for_both) {
  gltf::Document document = tetrahedron_document();
  document.json["nodes"].push_back({{"mesh", 0}, {"translation", {0, 0, 9}}});
  document.json["scenes"][0]["nodes"] = {0, 1};
  const Saved saved = rig_and_load(document);
  EXPECT_EQ(saved.document.json["meshes"].size(), 2u);
  EXPECT_EQ(saved.asset.mesh.positions.size(), 8u);
  EXPECT_VEC3_NEAR(saved.asset.mesh.positions[VertexId{5}], Vec3f(1, 0, 9), 1e-6f);
  expect_same_weights(*saved.asset.weights, spread_weights(8, 3), 1e-6f);
}

TEST(SaveGlb, meshes_keep_their_order_wherever_they_hung) {
  gltf::Document document = tetrahedron_document();
  document.json["nodes"] = Json::parse(
      R"([{"children": [1]}, {"mesh": 0}, {"mesh": 0, "translation": [5, 0, 0]}, {"mesh": 0, "translation": [9, 0, 0], "children": [4]},
                                          {"name": "socket"}])");
  document.json["scenes"][0]["nodes"] = {2, 3, 0};
  const TemporaryFolder folder;
  const Asset before = load(write_document(folder / "in.glb", document));
  EXPECT_EQ(save_and_load(before, chain(), spread_weights(12, 3)).asset.mesh.positions, before.mesh.positions);
}

TEST(SaveGlb, nodes_keep_their_numbers_where_an_unknown_extension_may_use_them) {
  gltf::Document document = skinned_tetrahedron_document();
  document.json["extensionsUsed"].push_back("ACME_points_at_nodes");
  document.json["nodes"].push_back({{"name", "above"}, {"children", {0}}});
  document.json["scenes"][0]["nodes"] = {3, 1};
  const Json json = rig_and_load(document).document.json;
  EXPECT_EQ(json["nodes"].size(), 4u + 3u);
  EXPECT_EQ(json["nodes"][3].dump(), R"({"name":"above"})");
  EXPECT_EQ(json["scenes"][0]["nodes"].dump(), "[0,4]");
}

TEST(SaveGlb, children_of_a_mesh_keep_their_place) {
  gltf::Document document = tetrahedron_document();
  document.json["cameras"] = Json::array({Json::parse(R"({"type": "perspective", "perspective": {"yfov": 1.0, "znear": 0.1}})")});
  document.json["nodes"][0]["translation"] = {1, 2, 3};
  document.json["nodes"][0]["children"] = {1};
  document.json["nodes"].push_back({{"name", "eye"}, {"camera", 0}});
  const Saved saved = rig_and_load(document);
  const Json& nodes = saved.document.json["nodes"];
  EXPECT_EQ(nodes[0]["translation"].dump(), "[1,2,3]");
  EXPECT_FALSE(nodes[0].contains("mesh"));
  EXPECT_EQ(nodes[2].dump(), R"({"name":"body","mesh":0,"skin":0})");
  EXPECT_VEC3_NEAR(saved.asset.mesh.positions[VertexId{0}], Vec3f(1, 2, 3), 1e-6f);
}

TEST(SaveGlb, the_rig_that_was_there_goes_with_its_animations) {
  gltf::Document document = skinned_tetrahedron_document();
  gltf::Writer writer(document);
  const std::vector<float> moves{0, 0, 0, 1, 1, 1};
  const std::size_t input = writer.vectors(std::vector<float>{0, 1, 0, 1}, 2, gltf::Target::none);
  document.json["accessors"][input] = {{"bufferView", document.json["accessors"][input]["bufferView"]},
                                       {"componentType", 5126},
                                       {"count", 2},
                                       {"type", "SCALAR"},
                                       {"min", {0}},
                                       {"max", {1}}};
  const std::size_t output = writer.vectors(moves, 3, gltf::Target::none);
  document.json["animations"] =
      Json::array({Json{{"name", "wave"},
                        {"samplers", Json::array({Json{{"input", input}, {"output", output}}})},
                        {"channels", Json::array({Json{{"sampler", 0}, {"target", {{"node", 2}, {"path", "translation"}}}}})}}});
  const Saved saved = rig_and_load(document);
  const Json& json = saved.document.json;
  EXPECT_FALSE(json.contains("animations"));
  EXPECT_EQ(json["skins"].size(), 1u);
  EXPECT_EQ(json["nodes"].size(), 4u);
  EXPECT_EQ(json["accessors"].size(), 4u + 3u) << "positions, normals, coordinates, indices; joints, weights, matrices";
  EXPECT_EQ(saved.asset.mesh.positions.raw(), kCorners);
  EXPECT_EQ(json["images"][0]["mimeType"], "image/png");
  expect_same_skeleton(*saved.asset.skeleton, chain());
  EXPECT_TRUE(has_repair(saved.changes, "replaced the rig that the asset had (2 joints)"));
  EXPECT_TRUE(has_repair(saved.changes, "removed animations that moved only what the new rig moves now: 'wave'"));
}

TEST(SaveGlb, extensions_that_describe_the_old_rig_go_and_others_stay) {
  gltf::Document document = skinned_tetrahedron_document();
  document.json["extensionsUsed"] = {"VRMC_vrm", "VRMC_materials_mtoon"};
  document.json["extensions"] = {{"VRMC_vrm", {{"humanoid", {{"hips", {{"node", 1}}}}}}}};
  document.json["materials"][0]["extensions"] = {{"VRMC_materials_mtoon", {{"specVersion", "1.0"}}}};
  const Saved saved = rig_and_load(document);
  EXPECT_FALSE(saved.document.json.contains("extensions"));
  EXPECT_EQ(saved.document.json["extensionsUsed"].dump(), R"(["VRMC_materials_mtoon"])");
  EXPECT_EQ(saved.document.json["materials"][0]["extensions"].dump(), R"({"VRMC_materials_mtoon":{"specVersion":"1.0"}})");
  EXPECT_TRUE(has_repair(saved.changes, "removed the extension VRMC_vrm"));
}

TEST(SaveGlb, morph_weights_stay_animated_on_the_meshs_new_node) {
  gltf::Document document = tetrahedron_document();
  const auto channel = [](int node, const char* path) { return Json{{"sampler", 0}, {"target", {{"node", node}, {"path", path}}}}; };
  document.json["animations"] =
      Json::array({Json{{"samplers", Json::array({Json{{"input", 0}, {"output", 0}}})},
                        {"channels", Json::array({channel(0, "weights"), channel(0, "translation"), channel(1, "scale")})}}});
  document.json["nodes"][0]["children"] = {1};
  document.json["nodes"].push_back({{"name", "socket"}});
  const Json json = rig_and_load(document).document.json;
  ASSERT_EQ(json["nodes"][2]["mesh"], 0);
  EXPECT_EQ(json["animations"][0]["channels"].dump(),
            Json::array({channel(2, "weights"), channel(0, "translation"), channel(1, "scale")}).dump());
}

TEST(SaveGlb, a_skin_that_deforms_its_mesh_is_rewritten_as_it_stood) {
  gltf::Document document = skinned_tetrahedron_document();
  document.json["nodes"][2]["translation"] = {1, 4, 0};
  const Saved saved = rig_and_load(document);
  EXPECT_VEC3_NEAR(saved.asset.mesh.positions[VertexId{1}], Vec3f(1, 4, 0), 1e-6f);
  EXPECT_VEC3_NEAR(saved.asset.mesh.positions[VertexId{2}], Vec3f(0, 2, 0), 1e-6f);
}

TEST(SaveGlb, files_beside_a_gltf_move_into_the_glb) {
  const TemporaryFolder folder;
  gltf::Document document = tetrahedron_document();
  write(folder / "mesh.bin", {reinterpret_cast<const char*>(document.buffers[0].data()), document.buffers[0].size()});
  write(folder / "face.jpg", "\xFF\xD8\xFF picture");
  document.json["buffers"][0]["uri"] = "mesh.bin";
  document.json["images"].push_back({{"uri", "face.jpg"}});
  document.json["images"].push_back({{"uri", "gone.png"}});
  const Asset asset = load(write(folder / "in.gltf", document.json.dump()));
  const Saved saved = save_and_load(asset, chain(), spread_weights(4, 3));
  EXPECT_FALSE(saved.document.json["buffers"][0].contains("uri"));
  EXPECT_EQ(saved.document.json["images"][1]["mimeType"], "image/jpeg");
  EXPECT_EQ(saved.document.json["images"][2]["uri"], "gone.png");
  EXPECT_TRUE(has_repair(saved.changes, "gone.png: no such file; the image stays a reference"));
}

// The tetrahedron with the skeleton of another file.
Saved save_with_skeleton_of(const gltf::Document& other) {
  const TemporaryFolder folder;
  const Asset asset = load(write_document(folder / "in.glb", tetrahedron_document()));
  const SkeletonFile skeleton = load_skeleton_file(write_document(folder / "other.glb", other));
  const Eigen::Affine3d fit(Eigen::Translation3d(0, 0, 1));
  auto changes = save_glb(folder / "out.glb", asset, skeleton, fit, spread_weights(4, skeleton.skeleton.size()));
  return {load(folder / "out.glb"), read_document(folder / "out.glb"), std::move(changes)};
}

TEST(SaveGlb, a_given_skeleton_with_a_joint_scaled_to_nothing_is_written_anew) {
  gltf::Document other = skinned_tetrahedron_document();
  other.json["nodes"][2]["scale"] = {0, 0, 0};
  const Saved saved = save_with_skeleton_of(other);
  EXPECT_TRUE(has_repair(saved.changes, "a joint is scaled to nothing"));
  EXPECT_EQ(saved.asset.skeleton->rest_positions[JointId{1}], Vec3f(1.5f, 0, 1));
  for (const float x : floats_of(saved.document, saved.document.json["skins"][0]["inverseBindMatrices"])) EXPECT_TRUE(std::isfinite(x));
}

TEST(SaveGlb, each_node_of_a_given_skeleton_has_one_place_whatever_its_file_says) {
  gltf::Document other = skinned_tetrahedron_document();
  other.json["nodes"][1]["children"] = {2, 2};
  other.json["nodes"][2]["children"] = {1, 2};
  const Saved saved = save_with_skeleton_of(other);
  std::vector<std::size_t> children;
  for (const Json& node : saved.document.json["nodes"])
    for (const Json& child : node.value("children", Json::array())) children.push_back(child.get<std::size_t>());
  EXPECT_EQ(children, (std::vector<std::size_t>{2, 1}));
  EXPECT_THAT(saved.asset.repairs, testing::IsEmpty());
}

TEST(SaveGlb, names_that_readers_trip_over_are_changed_and_said_so) {
  const TemporaryFolder folder;
  const Asset asset = load(write_document(folder / "in.glb", tetrahedron_document()));
  Skeleton skeleton;
  skeleton.add("mixamorig:Hips", std::nullopt, Vec3f(0, 0, 0));
  skeleton.add("body", JointId{0}, Vec3f(0, 1, 0));
  skeleton.add("\xC3\xBC", JointId{1}, Vec3f(0, 2, 0));
  const Saved saved = save_and_load(asset, skeleton, spread_weights(4, 3));
  EXPECT_EQ(saved.asset.skeleton->names.raw(), (std::vector<std::string>{"mixamorig_Hips", "body_1", "_"}));
  EXPECT_TRUE(has_repair(saved.changes, "joint 'body' is named 'body_1'"));
}

// Weights -------------------------------------------------------------------------------------------------------------------------------

TEST(SaveGlb, at_most_so_many_influences_are_kept_the_largest) {
  const TemporaryFolder folder;
  const Asset asset = load(write_document(folder / "in.glb", tetrahedron_document()));
  Skeleton skeleton = chain();
  for (int j = 3; j < 10; ++j) skeleton.add(fmt::format("j{}", j), JointId{2}, Vec3f(0, 1, 0));
  const SkinWeights weights = spread_weights(4, 10);
  EXPECT_EQ(save_and_load(asset, skeleton, weights).asset.weights->max_influences(), 4u);
  const Saved eight = save_and_load(asset, skeleton, weights, {.max_influences = 8});
  EXPECT_EQ(eight.asset.weights->max_influences(), 8u);
  EXPECT_TRUE(eight.document.json["meshes"][0]["primitives"][0]["attributes"].contains("WEIGHTS_1"));
  EXPECT_EQ((*eight.asset.weights)[VertexId{0}][0].joint, weights[VertexId{0}][0].joint);
}

TEST(SaveGlb, more_joints_than_8_bits_hold_get_16) {
  const TemporaryFolder folder;
  const Asset asset = load(write_document(folder / "in.glb", tetrahedron_document()));
  Skeleton skeleton;
  for (std::uint16_t j = 0; j < 300; ++j)
    skeleton.add(fmt::format("j{}", j), j > 0 ? std::optional(JointId(j - 1)) : std::nullopt, Vec3f(0, 0.1f * j, 0),
                 Quatf(Eigen::AngleAxisf(0.3f * j, Vec3f::UnitX())));
  SkinWeights weights;
  for (std::uint16_t v = 0; v < 4; ++v) weights.append(std::vector<Influence>{{JointId(299 - v), 1.0f}});
  const Saved saved = save_and_load(asset, skeleton, weights);
  EXPECT_EQ(*saved.asset.weights, weights);
  EXPECT_VEC3_NEAR(saved.asset.skeleton->rest_positions[JointId{299}], Vec3f(0, 29.9f, 0), 1e-5f)
      << "rounding does not add up along the chain";
  EXPECT_TRUE(has_repair(saved.changes, "300 joints; viewers on Android show at most 254"));
}

TEST(SaveGlb, quantized_weights_sum_exactly_and_are_near) {
  for (const auto& [format, total] : {std::pair{WeightFormat::u8, 255.0f}, std::pair{WeightFormat::u16, 65535.0f}}) {
    const Saved saved = rig_and_load(tetrahedron_document(), {.weights = format});
    expect_same_weights(*saved.asset.weights, spread_weights(4, 3), 1.0f / total);
    const auto stored = floats_of(saved.document, saved.document.json["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"]);
    for (std::size_t v = 0; v < stored.size(); v += 4)
      EXPECT_EQ(std::round(stored[v] * total) + std::round(stored[v + 1] * total) + std::round(stored[v + 2] * total) +
                    std::round(stored[v + 3] * total),
                total);
  }
}

TEST(Quantized, the_largest_remainders_take_what_is_left) {
  EXPECT_EQ(gltf::quantized(std::vector<float>{0.5f, 0.5f}, 255), (std::vector<std::uint32_t>{128, 127}));
  EXPECT_EQ(gltf::quantized(std::vector<float>{1.0f / 3, 1.0f / 3, 1.0f / 3}, 255), (std::vector<std::uint32_t>{85, 85, 85}));
  EXPECT_EQ(gltf::quantized(std::vector<float>{0.998f, 0.002f}, 255), (std::vector<std::uint32_t>{254, 1}));
  EXPECT_EQ(gltf::quantized(std::vector<float>{1.0f}, 65535), (std::vector<std::uint32_t>{65535}));
}

// A mesh that is no document --------------------------------------------------------------------------------------------------------------

TEST(SaveGlb, a_bare_mesh_becomes_a_new_document) {
  Asset asset;
  asset.mesh = shapes::icosphere(2);
  const Saved saved = save_and_load(asset, chain(), spread_weights(asset.mesh.positions.size(), 3));
  EXPECT_EQ(saved.asset.mesh.positions, asset.mesh.positions) << "without seams the vertices keep their numbers";
  EXPECT_EQ(saved.asset.mesh.faces, asset.mesh.faces);
  EXPECT_NEAR(surface_area(saved.asset.mesh), surface_area(asset.mesh), 1e-5);
  const auto normals = floats_of(saved.document, saved.document.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"]);
  for (const VertexId v : saved.asset.mesh.positions.ids())
    EXPECT_VEC3_NEAR(Vec3f(normals.data() + 3 * index(v)), saved.asset.mesh.positions[v], 0.03f)
        << "a unit sphere's normals are its points";
}

TEST(SaveGlb, faces_without_three_different_vertices_are_left_out_of_a_new_document) {
  Asset asset;
  asset.mesh = shapes::icosphere(0);
  asset.mesh.faces.push_back({VertexId{0}, VertexId{0}, VertexId{1}});
  EXPECT_EQ(save_and_load(asset, chain(), spread_weights(12, 3)).asset.mesh.faces.size(), 20u);
}

TEST(SaveGlb, more_vertices_than_16_bits_hold_get_32_bit_indices) {
  Asset asset;
  asset.mesh = shapes::sheet(300, 300);
  const Saved saved = save_and_load(asset, chain(), spread_weights(asset.mesh.positions.size(), 3));
  EXPECT_EQ(saved.asset.mesh.faces.size(), asset.mesh.faces.size());
  const std::size_t indices = saved.document.json["meshes"][0]["primitives"][0]["indices"];
  EXPECT_EQ(saved.document.json["accessors"][indices]["componentType"], 5125);
}

TEST(SaveGlb, a_broken_rig_is_refused_and_nothing_is_written) {
  const TemporaryFolder folder;
  Asset asset;
  asset.mesh = shapes::icosphere(0);
  EXPECT_THAT(error_of([&] { save_glb(folder / "x.glb", asset, chain(), spread_weights(11, 3)); }),
              testing::HasSubstr("weights for 11 vertices"));
  EXPECT_THAT(error_of([&] { save_glb(folder / "no" / "x.glb", asset, chain(), spread_weights(12, 3)); }),
              testing::HasSubstr("cannot write"));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace osteon::io
