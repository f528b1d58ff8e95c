// SPDX-License-Identifier: Apache-2.0
#include "files.h"
#include "osteon/io/load.h"

namespace osteon::io {
namespace {

using namespace osteon::io::test;
using gltf::Json;

Asset load_document(const gltf::Document& document, const LoadOptions& options = {}) {
  const TemporaryFolder folder;
  return load(write_document(folder / "asset.glb", document), options);
}

constexpr VertexId v0{0}, v1{1}, v2{2}, v3{3};

TEST(GltfLoad, positions_and_faces_come_in_the_files_order) {
  const Asset asset = load_document(tetrahedron_document());
  EXPECT_EQ(asset.mesh.positions.raw(), kCorners);
  ASSERT_EQ(asset.mesh.faces.size(), 4u);
  EXPECT_EQ(asset.mesh.faces[FaceId{1}], (Triangle{v0, v1, v3}));
  EXPECT_FALSE(asset.skeleton || asset.weights);
  EXPECT_THAT(asset.repairs, testing::IsEmpty());
}

TEST(GltfLoad, a_nodes_transform_and_those_above_it_place_the_mesh) {
  gltf::Document document = tetrahedron_document();
  document.json["nodes"][0]["translation"] = {1, 0, 0};
  document.json["nodes"].push_back({{"children", {0}}, {"scale", {2, 2, 2}}, {"rotation", {0, 0.70710678, 0, 0.70710678}}});
  document.json["scenes"][0]["nodes"] = {1};
  const Asset asset = load_document(document);
  EXPECT_VEC3_NEAR(asset.mesh.positions[v0], Vec3f(0, 0, -2), 1e-6f);
  EXPECT_VEC3_NEAR(asset.mesh.positions[v1], Vec3f(0, 0, -4), 1e-6f);
  EXPECT_VEC3_NEAR(asset.mesh.positions[v2], Vec3f(0, 2, -2), 1e-6f);
}

TEST(GltfLoad, a_matrix_places_the_mesh_as_its_columns_say) {
  gltf::Document document = tetrahedron_document();
  document.json["nodes"][0]["matrix"] = {0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1};  // mirrors x and y
  const Asset asset = load_document(document);
  EXPECT_VEC3_NEAR(asset.mesh.positions[v1], Vec3f(5, 7, 7), 1e-6f);
  EXPECT_EQ(asset.mesh.faces[FaceId{1}], (Triangle{v0, v3, v1})) << "a mirrored face keeps its outside";
}

TEST(GltfLoad, a_mesh_shown_twice_is_there_twice) {
  gltf::Document document = tetrahedron_document();
  document.json["nodes"].push_back({{"mesh", 0}, {"translation", {0, 0, 9}}});
  document.json["scenes"][0]["nodes"] = {0, 1};
  const Asset asset = load_document(document);
  ASSERT_EQ(asset.mesh.positions.size(), 8u);
  EXPECT_VEC3_NEAR(asset.mesh.positions[VertexId{5}], Vec3f(1, 0, 9), 1e-6f);
  EXPECT_EQ(asset.mesh.faces[FaceId{5}], (Triangle{VertexId{4}, VertexId{5}, VertexId{7}}));
}

TEST(GltfLoad, primitives_that_share_positions_share_vertices) {
  gltf::Document document = tetrahedron_document();
  Json& primitives = document.json["meshes"][0]["primitives"];
  primitives.push_back(Json(primitives[0]));
  const Asset asset = load_document(document);
  EXPECT_EQ(asset.mesh.positions.size(), 4u);
  EXPECT_EQ(asset.mesh.faces.size(), 8u);
}

TEST(GltfLoad, strips_and_fans_turn_as_their_first_triangle) {
  for (const auto& [mode, second] : {std::pair{5, Triangle{v1, v3, v2}}, std::pair{6, Triangle{v2, v3, v0}}}) {
    gltf::Document document = tetrahedron_document();
    Json& primitive = document.json["meshes"][0]["primitives"][0];
    primitive["mode"] = mode;
    primitive.erase("indices");
    const Asset asset = load_document(document);
    ASSERT_EQ(asset.mesh.faces.size(), 2u);
    EXPECT_EQ(asset.mesh.faces[FaceId{1}], second);
  }
}

TEST(GltfLoad, quantized_positions_are_what_the_node_makes_of_them) {
  gltf::Document document = tetrahedron_document();
  document.json["extensionsUsed"] = document.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  gltf::Writer writer(document);
  const std::vector<std::uint32_t> corners{0, 0, 0, 0, 65535, 0, 0, 0, 0, 65535, 0, 0, 0, 0, 65535, 0};  // padded to 8 bytes each
  const std::size_t accessor = writer.vec4(corners, 2, true);
  document.json["accessors"][accessor]["type"] = "VEC3";
  document.json["bufferViews"].back()["byteStride"] = 8;
  document.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = accessor;
  document.json["nodes"][0]["scale"] = {3, 3, 3};
  const Asset asset = load_document(document);
  EXPECT_VEC3_NEAR(asset.mesh.positions[v2], Vec3f(0, 3, 0), 1e-6f);
}

TEST(GltfLoad, sparse_values_replace_those_they_name) {
  gltf::Document document = tetrahedron_document();
  gltf::Writer writer(document);
  const std::vector<std::uint32_t> places{2};
  const std::vector<float> values{7, 8, 9};
  const auto view_of = [&](std::size_t accessor) { return document.json["accessors"][accessor]["bufferView"]; };
  const Json indices = view_of(writer.scalars(places)), replacement = view_of(writer.vectors(values, 3, gltf::Target::vertices));
  document.json["accessors"][0]["sparse"] = {
      {"count", 1}, {"indices", {{"bufferView", indices}, {"componentType", 5123}}}, {"values", {{"bufferView", replacement}}}};
  const Asset asset = load_document(document);
  EXPECT_EQ(asset.mesh.positions[v2], Vec3f(7, 8, 9));
  EXPECT_EQ(asset.mesh.positions[v1], Vec3f(1, 0, 0));
}

TEST(GltfLoad, a_skin_gives_joints_and_weights) {
  const Asset asset = load_document(skinned_tetrahedron_document());
  ASSERT_TRUE(asset.skeleton && asset.weights);
  EXPECT_EQ(asset.skeleton->names.raw(), (std::vector<std::string>{"hip", "knee"}));
  EXPECT_VEC3_NEAR(asset.skeleton->rest_positions[JointId{1}], Vec3f(1.5f, 0, 0), 1e-6f);
  EXPECT_EQ(asset.skeleton->parents[JointId{1}], JointId{0});
  EXPECT_EQ(asset.mesh.positions.raw(), kCorners);
  EXPECT_EQ((*asset.weights)[v2].size(), 2u);
  EXPECT_EQ((*asset.weights)[v2][1], (Influence{JointId{1}, 0.25f}));
}

TEST(GltfLoad, the_node_of_a_skinned_mesh_does_not_move_it) {
  gltf::Document document = skinned_tetrahedron_document();
  document.json["nodes"][0]["translation"] = {100, 0, 0};
  EXPECT_EQ(load_document(document).mesh.positions.raw(), kCorners);
}

TEST(GltfLoad, a_rest_pose_that_is_not_the_bind_pose_moves_the_vertices_of_its_joints) {
  gltf::Document document = skinned_tetrahedron_document();
  document.json["nodes"][2]["translation"] = {1, 4, 0};
  const Asset asset = load_document(document);
  EXPECT_VEC3_NEAR(asset.mesh.positions[v0], Vec3f(0, 0, 0), 1e-6f);
  EXPECT_VEC3_NEAR(asset.mesh.positions[v1], Vec3f(1, 4, 0), 1e-6f);
  EXPECT_VEC3_NEAR(asset.mesh.positions[v2], Vec3f(0, 2, 0), 1e-6f) << "a quarter of it";
}

TEST(GltfLoad, joints_listed_before_their_parents_are_put_behind_them) {
  gltf::Document document = skinned_tetrahedron_document();
  document.json["skins"][0]["joints"] = {2, 1};
  document.json["skins"][0].erase("inverseBindMatrices");
  const Asset asset = load_document(document);
  EXPECT_EQ(asset.skeleton->names.raw(), (std::vector<std::string>{"hip", "knee"}));
  EXPECT_EQ((*asset.weights)[v1][0].joint, JointId{0}) << "index 1 of the skin is the hip here";
}

TEST(GltfLoad, two_root_joints_get_one_above_them) {
  gltf::Document document = skinned_tetrahedron_document();
  document.json["nodes"][1].erase("children");
  document.json["scenes"][0]["nodes"] = {0, 1, 2};
  const Asset asset = load_document(document);
  EXPECT_EQ(asset.skeleton->size(), 3u);
  EXPECT_EQ(asset.skeleton->names[JointId{0}], "root");
  EXPECT_TRUE(has_repair(asset.rig_repairs, "2 root joints; joined under a new one"));
}

TEST(GltfLoad, a_mesh_without_skin_follows_the_joint_above_it) {
  gltf::Document document = skinned_tetrahedron_document();
  document.json["meshes"].push_back(tetrahedron_document().json["meshes"][0]);
  document.json["nodes"].push_back({{"name", "hat"}, {"mesh", 1}});
  document.json["nodes"][2]["children"] = {3};
  const Asset asset = load_document(document);
  ASSERT_EQ(asset.mesh.positions.size(), 8u);
  EXPECT_VEC3_NEAR(asset.mesh.positions[VertexId{4}], Vec3f(1.5f, 0, 0), 1e-6f);
  EXPECT_EQ((*asset.weights)[VertexId{4}][0], (Influence{JointId{1}, 1.0f}));
}

TEST(GltfLoad, a_mesh_that_is_bound_to_the_root_for_want_of_a_joint_is_named) {
  gltf::Document document = skinned_tetrahedron_document();
  document.json["meshes"].push_back(tetrahedron_document().json["meshes"][0]);
  document.json["nodes"].push_back({{"name", "sword"}, {"mesh", 1}});
  document.json["scenes"][0]["nodes"].push_back(3);
  const Asset asset = load_document(document);
  EXPECT_TRUE(has_repair(asset.rig_repairs, "mesh 'sword' is not skinned and under no joint; bound to the root"));
  EXPECT_THAT(asset.repairs, testing::IsEmpty()) << "nothing to who replaces the rig";
}

TEST(GltfLoad, up_and_scale_overrule_the_file) {
  const Asset asset = load_document(tetrahedron_document(), {.up = UpAxis::z, .scale = 0.01f});
  EXPECT_VEC3_NEAR(asset.mesh.positions[v3], Vec3f(0, 0.01f, 0), 1e-8f);
  EXPECT_VEC3_NEAR(asset.mesh.positions[v2], Vec3f(0, 0, -0.01f), 1e-8f);
}

TEST(GltfLoad, a_gltf_reads_its_buffer_beside_it_or_from_a_data_uri) {
  const TemporaryFolder folder;
  gltf::Document document;
  document.json =
      Json::parse(R"({"asset": {"version": "2.0"}, "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}], "bufferViews": [{"buffer": 0, "byteLength": 36}]})");
  const std::vector<float> corners{0, 0, 0, 1, 0, 0, 0, 1, 0};
  const std::string bytes(reinterpret_cast<const char*>(corners.data()), 36);
  document.json["buffers"] = Json::array({Json{{"byteLength", 36}, {"uri", "part%201.bin"}}});
  write(folder / "part 1.bin", bytes);
  EXPECT_EQ(load(write(folder / "a.gltf", document.json.dump())).mesh.positions[v2], Vec3f(0, 1, 0));
  document.json["buffers"][0]["uri"] = "data:application/octet-stream;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA";
  EXPECT_EQ(load(write(folder / "b.gltf", document.json.dump())).mesh.positions[v2], Vec3f(0, 1, 0));
}

TEST(GltfLoad, a_skeleton_can_be_read_alone) {
  const TemporaryFolder folder;
  EXPECT_EQ(load_skeleton(write_document(folder / "a.glb", skinned_tetrahedron_document())).size(), 2u);
  gltf::Document document = skinned_tetrahedron_document();
  for (const char* key : {"meshes", "skins"}) document.json.erase(key);
  document.json["nodes"].erase(0);
  document.json["nodes"][0]["children"] = {1};
  document.json["scenes"][0]["nodes"] = {0};
  EXPECT_EQ(load_skeleton(write_document(folder / "b.glb", document)).names[JointId{1}], "knee");
}

}  // namespace
}  // namespace osteon::io
