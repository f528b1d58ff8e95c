// SPDX-License-Identifier: Apache-2.0
#include "files.h"
#include "osteon/io/save.h"

namespace osteon::io {
namespace {

using namespace osteon::io::test;
using gltf::Json;

// The skinned tetrahedron as an artist's file: the knee is turned, so that vertices do not stand where they were bound; a socket hangs from
// it (node 3), and a clip moves it.
gltf::Document posed_document() {
  gltf::Document document = skinned_tetrahedron_document();
  Json& nodes = document.json["nodes"];
  nodes[2]["rotation"] = {0, 0, 0.6, 0.8};
  nodes[2]["extras"] = {{"stretch", 0.1}};
  nodes[2]["children"] = {3};
  nodes.push_back({{"name", "socket"}, {"translation", {0, 0.5, 0}}, {"extras", {{"holds", "lamp"}}}});
  gltf::Writer writer(document);
  const std::size_t turns = writer.vectors(std::vector<float>{0, 0, 0, 1, 0, 0, 0.6f, 0.8f}, 4, gltf::Target::none);
  document.json["animations"] =
      Json::array({Json{{"name", "kick"},
                        {"samplers", Json::array({Json{{"input", 0}, {"output", turns}}})},
                        {"channels", Json::array({Json{{"sampler", 0}, {"target", {{"node", 2}, {"path", "rotation"}}}}})}}});
  return document;
}

struct Rebound {
  Asset before, after;
  Json was, is;
  gltf::Document document;
  std::vector<std::string> changes;
};

Rebound bound_to_first_joint(const gltf::Document& in, const LoadOptions& load_options = {}) {
  const TemporaryFolder folder;
  const Asset before = load(write_document(folder / "in.glb", in), load_options);
  SkinWeights weights;
  const Influence whole{JointId{0}, 1.0f};
  for (std::size_t v = 0; v < before.mesh.positions.size(); ++v) weights.append({&whole, 1});
  auto changes = save_weights(folder / "out.glb", before, weights);
  gltf::Document out = read_document(folder / "out.glb");
  return {before, load(folder / "out.glb"), in.json, out.json, out, std::move(changes)};
}

void expect_same_places(const Asset& a, const Asset& b) {
  ASSERT_EQ(a.mesh.positions.size(), b.mesh.positions.size());
  for (const VertexId v : a.mesh.positions.ids()) EXPECT_VEC3_NEAR(a.mesh.positions[v], b.mesh.positions[v], 1e-6f);
  ASSERT_EQ(a.skeleton->names, b.skeleton->names);
  for (const JointId j : a.skeleton->names.ids()) EXPECT_VEC3_NEAR(a.skeleton->rest_positions[j], b.skeleton->rest_positions[j], 1e-6f);
}

TEST(SaveWeights, a_character_out_of_its_bind_pose_keeps_its_nodes_and_clips_and_stands_as_it_stood) {
  const Rebound rebound = bound_to_first_joint(posed_document());
  EXPECT_EQ(rebound.is["nodes"], rebound.was["nodes"]);
  EXPECT_EQ(rebound.is["animations"][0]["channels"], rebound.was["animations"][0]["channels"]);
  EXPECT_EQ(rebound.is["skins"][0]["joints"], rebound.was["skins"][0]["joints"]);
  expect_same_places(rebound.before, rebound.after);
  EXPECT_VEC3_NEAR(rebound.after.mesh.positions[VertexId{1}], Vec3f(1.36f, -0.48f, 0), 1e-6f) << "turned about the knee";
  EXPECT_EQ((*rebound.after.weights)[VertexId{1}][0].joint, JointId{0});
  EXPECT_THAT(rebound.changes, testing::ElementsAre("skin 0 was not in its bind pose; its meshes are bound as they stand"));
}

TEST(SaveWeights, a_mesh_outside_the_scene_keeps_the_skin_as_it_was) {
  gltf::Document document = posed_document();
  document.json["nodes"].push_back({{"name", "spare"}, {"mesh", 0}, {"skin", 0}});
  document.json["scenes"].push_back({{"nodes", {4}}});
  const Rebound rebound = bound_to_first_joint(document);
  EXPECT_EQ(rebound.is["nodes"][0]["skin"], 0);
  EXPECT_EQ(rebound.is["nodes"][4]["skin"], 1);
  const auto matrices_of = [&](const gltf::Document& d, std::size_t skin) {
    return gltf::Accessor(d, d.json["skins"][skin]["inverseBindMatrices"].get<std::size_t>()).floats();
  };
  EXPECT_EQ(matrices_of(rebound.document, 1), matrices_of(document, 0));
  expect_same_places(rebound.before, rebound.after);
}

TEST(SaveWeights, a_mesh_with_a_skin_but_no_weights_stays_where_its_node_put_it) {
  gltf::Document document = posed_document();
  Json& attributes = document.json["meshes"][0]["primitives"][0]["attributes"];
  attributes.erase("JOINTS_0");
  attributes.erase("WEIGHTS_0");
  document.json["nodes"][0]["translation"] = {0, 3, 0};
  expect_same_places(bound_to_first_joint(document).before, bound_to_first_joint(document).after);
}

TEST(SaveWeights, vertices_that_are_not_finite_are_repaired_and_the_skin_stays) {
  gltf::Document document = skinned_tetrahedron_document();
  gltf::Writer writer(document);
  std::vector<Vec3f> corners = kCorners;
  corners[3].x() = std::numeric_limits<float>::quiet_NaN();
  document.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = writer.positions(corners);
  const Rebound rebound = bound_to_first_joint(document);
  expect_same_places(rebound.before, rebound.after);
  EXPECT_EQ(rebound.after.mesh.positions[VertexId{3}], Vec3f(0, 0, 0));
  EXPECT_THAT(rebound.after.repairs, testing::IsEmpty());
  EXPECT_THAT(rebound.changes, testing::IsEmpty());
}

TEST(SaveWeights, a_file_read_in_other_units_and_turned_upright_comes_out_so_by_a_node_above_its_roots) {
  const LoadOptions z_up_in_centimetres{.up = UpAxis::z, .scale = 0.01f};
  for (gltf::Document document : {skinned_tetrahedron_document(), posed_document()}) {
    document.json["nodes"].push_back({{"name", "lamp"}, {"translation", {0, 0, 300}}});
    const std::size_t lamp = document.json["nodes"].size() - 1;
    document.json["scenes"][0]["nodes"].push_back(lamp);
    const Rebound rebound = bound_to_first_joint(document, z_up_in_centimetres);
    expect_same_places(rebound.before, rebound.after);
    for (std::size_t n = 0; n <= lamp; ++n) EXPECT_EQ(rebound.is["nodes"][n], rebound.was["nodes"][n]);
    EXPECT_EQ(rebound.is["scenes"][0]["nodes"], Json({0, lamp + 1, lamp + 2})) << "the mesh follows its joints";
    EXPECT_EQ(rebound.is["nodes"][lamp + 1]["children"], Json({1}));
    EXPECT_EQ(rebound.is["nodes"][lamp + 2]["children"], Json({lamp}));
    EXPECT_TRUE(has_repair(rebound.changes, "scaled and turned to metres and y up by a node above each root"));
  }
}

TEST(SaveWeights, a_mesh_without_skin_is_bound_where_it_stands_in_a_file_that_is_scaled) {
  gltf::Document document = skinned_tetrahedron_document();
  document.json["nodes"].push_back({{"name", "sword"}, {"mesh", 0}, {"translation", {0, 5, 0}}});
  document.json["nodes"][2]["children"] = {3};
  const Rebound rebound = bound_to_first_joint(document, {.up = {}, .scale = 2.0f});
  expect_same_places(rebound.before, rebound.after);
}

TEST(SaveWeights, a_joint_scaled_to_nothing_has_the_skeleton_written_anew) {
  gltf::Document document = posed_document();
  document.json["nodes"][2]["scale"] = {0, 0, 0};
  const Rebound rebound = bound_to_first_joint(document);
  expect_same_places(rebound.before, rebound.after);
  EXPECT_TRUE(has_repair(rebound.changes, "a joint is scaled to nothing"));
}

TEST(SaveWeights, a_mesh_without_weights_is_bound_to_no_joint_scaled_to_nothing) {
  for (const bool has_skin : {true, false}) {
    gltf::Document document = skinned_tetrahedron_document();
    for (const char* key : {"JOINTS_0", "WEIGHTS_0"}) document.json["meshes"][0]["primitives"][0]["attributes"].erase(key);
    if (!has_skin) document.json["nodes"][0].erase("skin");
    document.json["nodes"][1]["scale"] = {0, 0, 0};
    const Rebound rebound = bound_to_first_joint(document);
    expect_same_places(rebound.before, rebound.after);
    EXPECT_TRUE(has_repair(rebound.changes, "a joint is scaled to nothing"));
  }
}

}  // namespace
}  // namespace osteon::io
