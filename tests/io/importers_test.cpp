// SPDX-License-Identifier: Apache-2.0
// What OBJ, PLY, STL, DAE and FBX hold arrives; what is broken in them is in bad_input_test.cpp.
#include "files.h"
#include "osteon/io/appearance.h"
#include "osteon/io/assemble.h"
#include "osteon/io/load.h"
#include "osteon/io/rigtxt.h"
#include "osteon/io/save.h"
#include "osteon/io/scene_bytes.h"
#include "osteon/io/source_document.h"
#include "osteon/io/upright.h"
#include "osteon/mesh/shapes.h"

namespace osteon::io {
namespace {

using namespace osteon::io::test;

Asset load_text(const std::string& name, const std::string& content, const LoadOptions& options = {}) {
  const TemporaryFolder folder;
  return load(write(folder / name, content), options);
}

// OBJ -----------------------------------------------------------------------------------------------------------------------------------

TEST(Obj, polygons_groups_and_comments) {
  const Asset asset =
      load_text("a.obj", "# c\no thing\ng left\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0 # last\ns off\nf 1 2 3 4\ng\nl 1 2\nf 3 2 1\n");
  EXPECT_EQ(asset.mesh.positions.size(), 4u);
  ASSERT_EQ(asset.mesh.faces.size(), 3u);
  EXPECT_EQ(asset.mesh.faces[FaceId{2}], (Triangle{VertexId{2}, VertexId{1}, VertexId{0}}));
  EXPECT_THAT(asset.repairs, testing::IsEmpty());
}

TEST(Obj, negative_indices_count_back_from_the_face) {
  const Asset asset = load_text("a.obj", "v 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 5 5 5\n");
  EXPECT_EQ(asset.mesh.faces[FaceId{0}], (Triangle{VertexId{1}, VertexId{2}, VertexId{3}}));
}

TEST(Obj, faces_may_stand_before_their_vertices) {
  EXPECT_EQ(load_text("a.obj", "f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n").mesh.faces.size(), 1u);
}

TEST(Obj, line_ends_continuations_tabs_and_odd_numbers) {
  const Asset asset = load_text("a.obj", "\xEF\xBB\xBFv\t+0 0.0e0 -0\r\nv 1e0 0 0\rv 0 \\\n1 1e-60\r\nf  1//  2 3");
  EXPECT_VEC3_NEAR(asset.mesh.positions[VertexId{2}], Vec3f(0, 1, 0), 0.0f);
  EXPECT_EQ(asset.mesh.faces.size(), 1u);
}

TEST(Obj, utf16_is_read_too) {
  const std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl \xFC\nf 1 2 3\n";
  std::string wide = "\xFF\xFE";
  for (const char c : text) wide += {c, '\0'};
  const Asset asset = load_text("a.obj", wide);
  EXPECT_EQ(asset.mesh.positions[VertexId{2}], Vec3f(0, 1, 0));
  EXPECT_EQ(asset.source->appearance->materials[0].name, "\xC3\xBC");
}

TEST(Obj, normals_coordinates_colours_and_materials_are_kept_for_the_glb) {
  const TemporaryFolder folder;
  write(folder / "mats.mtl", "newmtl red\nKd 1 0 0\nd 0.5\nmap_Kd -s 1 1 1 tex\\red.png\nnewmtl unused\nKd 0 1 0\n");
  const Asset asset = load(write(folder / "a.obj",
                                 "mtllib mats.mtl\nv 0 0 0 1 0 0\nv 1 0 0 0 1 0\nv 0 1 0 0 0 1\nvt 0.25 0.75\nvn 0 0 2\nusemtl red\n"
                                 "f 1/1/1 2/1/1 3/1/1\nusemtl gone\nf 1/1 2/1 3/1\n"));
  const Appearance& appearance = *asset.source->appearance;
  EXPECT_VEC3_NEAR(appearance.normals.values[0], Vec3f(0, 0, 1), 0.0f);
  EXPECT_EQ(appearance.texture_coordinates.values[0], Eigen::Vector2f(0.25f, 0.25f)) << "v counts from the top";
  EXPECT_EQ(appearance.colours[2], Eigen::Vector4f(0, 0, 1, 1));
  ASSERT_EQ(appearance.materials.size(), 2u);
  EXPECT_EQ(appearance.materials[0].colour, Eigen::Vector4f(1, 0, 0, 0.5f));
  EXPECT_EQ(appearance.materials[0].base.file, folder.path() / "tex/red.png");
  EXPECT_EQ(appearance.materials[1].name, "gone");
  EXPECT_EQ(appearance.face_materials, (std::vector<std::uint32_t>{0, 1}));
}

TEST(Obj, a_seam_doubles_vertices_in_the_glb_and_both_get_the_weights) {
  const TemporaryFolder folder;
  const Asset asset = load(write(
      folder / "a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvt 0.5 0.5\nf 1/1 2/2 3/3\nf 1/5 3/3 4/4\n"));
  Skeleton skeleton;
  skeleton.add("root", std::nullopt, Vec3f(0, 0, 0));
  skeleton.add("tip", JointId{0}, Vec3f(0, 1, 0));
  SkinWeights weights;
  for (const float w : {0.1f, 0.2f, 0.3f, 0.4f}) weights.append(std::vector<Influence>{{JointId{0}, w}, {JointId{1}, 1 - w}});
  save_glb(folder / "a.glb", asset, skeleton, weights);
  const Asset back = load(folder / "a.glb");
  ASSERT_EQ(back.mesh.positions.size(), 5u);
  for (const VertexId v : back.mesh.positions.ids()) {
    const Vec3f& p = back.mesh.positions[v];
    const float expected = p.y() < 0.5f ? (p.x() < 0.5f ? 0.1f : 0.2f) : (p.x() > 0.5f ? 0.3f : 0.4f);
    EXPECT_NEAR((*back.weights)[v][1].weight, expected, 1e-6f);
  }
}

// Bound to one joint.
std::vector<std::string> save_as_glb(const std::filesystem::path& path, const Asset& asset) {
  Skeleton skeleton;
  skeleton.add("root", std::nullopt, Vec3f(0, 0, 0));
  SkinWeights weights;
  const Influence whole{JointId{0}, 1.0f};
  for (std::size_t v = 0; v < asset.mesh.positions.size(); ++v) weights.append({&whole, 1});
  return save_glb(path, asset, skeleton, weights);
}

TEST(Obj, objects_come_out_under_their_names) {
  const TemporaryFolder folder;
  const Asset asset =
      load(write(folder / "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\no body\nf 1 2 4\no h\xFCte\nf 2 3 4\no body\nf 1 4 3\n"));
  EXPECT_EQ(asset.mesh.positions.size(), 4u) << "in the file's order, whatever the objects";
  save_as_glb(folder / "a.glb", asset);
  const auto json = read_document(folder / "a.glb").json;
  ASSERT_EQ(json["meshes"].size(), 3u);
  EXPECT_EQ(json["nodes"][0]["name"], "body");
  EXPECT_EQ(json["nodes"][1]["name"], "h\xEF\xBF\xBDte") << "mended: it was not UTF-8";
  EXPECT_EQ(json["nodes"][2]["name"], "a") << "faces before the first object go by the name of the file";
  for (const auto& mesh : {0, 1, 2}) EXPECT_EQ(json["nodes"][mesh]["skin"], 0);
  const Asset back = load(folder / "a.glb");
  EXPECT_EQ(back.mesh.faces.size(), 4u);
  EXPECT_EQ(back.weights->size(), 4u + 3u + 3u);
}

TEST(Obj, normal_maps_and_surface_factors_are_kept_and_other_textures_named) {
  const TemporaryFolder folder;
  const std::string png = "\x89PNG\r\n\x1a\n not really";
  write(folder / "n.png", png);
  write(folder / "mats.mtl", "newmtl steel\nPm 0.75\nPr 0.25\nnorm n.png\nmap_Ks s.png\nmap_bump h.png\nnewmtl gold\nmap_Ks t.png\n");
  const Asset asset = load(write(
      folder / "a.obj", "mtllib mats.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nusemtl steel\nf 1/1 2/1 3/1\nusemtl gold\nf 1/1 3/1 2/1\n"));
  EXPECT_TRUE(has_repair(asset.repairs, "left out the map_Ks textures of 2 materials"));
  EXPECT_TRUE(has_repair(asset.repairs, "left out the map_bump textures of 1 materials"));
  save_as_glb(folder / "a.glb", asset);
  const auto material = read_document(folder / "a.glb").json["materials"][0];
  EXPECT_EQ(material["pbrMetallicRoughness"]["metallicFactor"], 0.75);
  EXPECT_EQ(material["pbrMetallicRoughness"]["roughnessFactor"], 0.25);
  EXPECT_EQ(material["normalTexture"]["index"], 0);
}

TEST(Obj, bump_maps_that_blender_writes_are_normal_maps) {
  const TemporaryFolder folder;
  write(folder / "mats.mtl", "# Blender MTL File: 'None'\nnewmtl skin\nmap_Bump -bm 1.0 n.png\n");
  const Asset asset = load(write(folder / "a.obj", "mtllib mats.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl skin\nf 1 2 3\n"));
  EXPECT_EQ(asset.source->appearance->materials[0].normals.file, folder.path() / "n.png");
  EXPECT_THAT(asset.repairs, testing::IsEmpty());
}

TEST(Obj, what_save_obj_writes_comes_back_exactly) {
  const TemporaryFolder folder;
  const TriangleMesh mesh = shapes::icosphere(2, 0.1f);
  save_obj(folder / "a.obj", mesh);
  const Asset asset = load(folder / "a.obj");
  EXPECT_EQ(asset.mesh.positions, mesh.positions);
  EXPECT_EQ(asset.mesh.faces, mesh.faces);
}

// PLY -----------------------------------------------------------------------------------------------------------------------------------

template <class T>
std::string bytes_of(T value, bool big_endian) {
  std::string bytes(reinterpret_cast<const char*>(&value), sizeof value);
  if (big_endian) std::reverse(bytes.begin(), bytes.end());
  return bytes;
}

std::string binary_ply(bool big) {
  std::string out = fmt::format(
      "ply\nformat binary_{}_endian 1.0\ncomment x\nelement extra 1\nproperty list uchar short junk\nelement vertex 4\nproperty double x\n"
      "property float y\nproperty short z\nproperty uchar red\nproperty uchar green\nproperty uchar blue\nelement face 2\n"
      "property list uchar int vertex_indices\nproperty uchar flags\nend_header\n",
      big ? "big" : "little");
  out += bytes_of<std::uint8_t>(2, big) + bytes_of<std::int16_t>(7, big) + bytes_of<std::int16_t>(8, big);
  for (const auto& [x, y, z] : {std::array{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 5}})
    out += bytes_of<double>(x, big) + bytes_of<float>(static_cast<float>(y), big) +
           bytes_of<std::int16_t>(static_cast<std::int16_t>(z), big) + "\xFF" + std::string(2, '\0');
  out += bytes_of<std::uint8_t>(4, big);
  for (const int i : {0, 1, 2, 3}) out += bytes_of<std::int32_t>(i, big);
  out += "\1" + bytes_of<std::uint8_t>(3, big);
  for (const int i : {3, 2, 1}) out += bytes_of<std::int32_t>(i, big);
  return out + "\2";
}

TEST(Ply, both_byte_orders_read_the_same) {
  for (const bool big : {false, true}) {
    const Asset asset = load_text("a.ply", binary_ply(big));
    ASSERT_EQ(asset.mesh.positions.size(), 4u);
    EXPECT_EQ(asset.mesh.positions[VertexId{3}], Vec3f(0, 1, 5));
    ASSERT_EQ(asset.mesh.faces.size(), 3u);
    EXPECT_EQ(asset.mesh.faces[FaceId{2}], (Triangle{VertexId{3}, VertexId{2}, VertexId{1}}));
    EXPECT_EQ(asset.source->appearance->colours[3], Eigen::Vector4f(1, 0, 0, 1));
    EXPECT_THAT(asset.repairs, testing::IsEmpty());
  }
}

TEST(Ply, ascii_with_normals_and_coordinates) {
  const Asset asset = load_text(
      "a.bin",
      "ply\r\nformat ascii 1.0\r\nelement vertex 3\r\nproperty float x\r\nproperty float y\r\nproperty float z\r\nproperty float nx\r\n"
      "property float ny\r\nproperty float nz\r\nproperty float s\r\nproperty float t\r\nelement face 1\r\nproperty list uchar uint "
      "vertex_index\r\nend_header\r\n0 0 0 0 0 1 0 0\r\n1 0 0 0 0 1 1 0\r\n0 1 0 0 0 1 0 1\r\n3 0 1 2\r\n");
  EXPECT_EQ(asset.mesh.faces.size(), 1u);
  EXPECT_EQ(asset.source->appearance->normals.values[1], Vec3f(0, 0, 1));
  EXPECT_EQ(asset.source->appearance->texture_coordinates.values[2], Eigen::Vector2f(0, 0));
}

TEST(Ply, strips_turn_every_other_triangle) {
  const Asset asset = load_text("a.ply",
                                "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement "
                                "tristrips 1\nproperty list int "
                                "int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n8 0 1 2 3 -1 0 1 3\n");
  ASSERT_EQ(asset.mesh.faces.size(), 3u);
  EXPECT_EQ(asset.mesh.faces[FaceId{1}], (Triangle{VertexId{2}, VertexId{1}, VertexId{3}}));
  EXPECT_EQ(asset.mesh.faces[FaceId{2}], (Triangle{VertexId{0}, VertexId{1}, VertexId{3}}));
}

// STL -----------------------------------------------------------------------------------------------------------------------------------

std::string binary_stl(const std::string& title) {
  std::string out = title;
  out.resize(80, ' ');
  out += bytes_of<std::uint32_t>(1, false) + std::string(12, '\0');
  for (const float x : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 2.f, 0.f}) out += bytes_of(x, false);
  return out + std::string(2, '\0');
}

TEST(Stl, binary_even_if_it_begins_with_solid) {
  for (const char* title : {"binary", "solid facet"})
    EXPECT_EQ(load_text("a.stl", binary_stl(title)).mesh.positions[VertexId{2}], Vec3f(0, 2, 0));
}

TEST(Stl, ascii) {
  const Asset asset = load_text("a.stl",
                                "solid x\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   vertex 0 2.5 0\n  "
                                "endloop\n endfacet\nendsolid x\n");
  EXPECT_EQ(asset.mesh.positions[VertexId{2}], Vec3f(0, 2.5f, 0));
  EXPECT_EQ(asset.mesh.faces.size(), 1u);
}

TEST(Stl, content_tells_the_format_whatever_the_name) { EXPECT_EQ(load_text("a.obj", binary_stl("x")).mesh.faces.size(), 1u); }

// rig.txt -------------------------------------------------------------------------------------------------------------------------------

const char* const kRig = "skin 1 b 0.25 a 0.75\njoints b 0 1 0\nhier a b\nroot a\njoints a 0 0 0.5\nskin 0 a 1.0\nskin 2 a 1\n";

TEST(RigText, lines_in_any_order_with_the_obj_beside_it) {
  const TemporaryFolder folder;
  write(folder / "hero.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const Asset asset = load(write(folder / "hero_rig.txt", kRig));
  EXPECT_EQ(asset.skeleton->names.raw(), (std::vector<std::string>{"a", "b"}));
  EXPECT_EQ((*asset.weights)[VertexId{1}][1], (Influence{JointId{1}, 0.25f}));
  EXPECT_VEC3_NEAR(asset.skeleton->rest_orientations[JointId{0}] * Vec3f::UnitY(), Vec3f(0, 1, -0.5f).normalized(), 1e-6f);
}

TEST(RigText, what_is_written_comes_back) {
  const TemporaryFolder folder;
  std::vector<std::string> repairs;
  const RigText before = load_rigtxt(write(folder / "a.txt", kRig), 3, repairs);
  save_rigtxt(folder / "b.txt", before.skeleton, *before.weights);
  const RigText after = load_rigtxt(folder / "b.txt", 3, repairs);
  EXPECT_EQ(after.skeleton.names, before.skeleton.names);
  EXPECT_EQ(after.skeleton.rest_positions, before.skeleton.rest_positions);
  EXPECT_EQ(*after.weights, *before.weights);
  EXPECT_THAT(repairs, testing::IsEmpty());
}

TEST(RigText, a_skeleton_can_be_read_without_a_mesh) {
  const TemporaryFolder folder;
  EXPECT_EQ(load_skeleton(write(folder / "a.txt", kRig)).size(), 2u);
}

// Through Assimp ------------------------------------------------------------------------------------------------------------------------

// A triangle in a Collada file in inches with z up, on a node moved by 10 along z.
std::string collada(const std::string& asset = "<unit name=\"inch\" meter=\"0.0254\"/><up_axis>Z_UP</up_axis>") {
  return "<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\"><asset>" + asset +
         "</asset><library_geometries><geometry id=\"g\"><mesh><source id=\"p\"><float_array id=\"pa\" count=\"9\">0 0 0 1 0 0 0 0 "
         "1</float_array>"
         "<technique_common><accessor source=\"#pa\" count=\"3\" stride=\"3\"><param name=\"X\" type=\"float\"/><param name=\"Y\" "
         "type=\"float\"/><param name=\"Z\" "
         "type=\"float\"/></accessor></technique_common></source><vertices id=\"v\"><input semantic=\"POSITION\" "
         "source=\"#p\"/></vertices><triangles "
         "count=\"1\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/><p>0 1 "
         "2</p></triangles></mesh></geometry></library_geometries>"
         "<library_visual_scenes><visual_scene id=\"s\"><node id=\"n\"><translate>0 0 10</translate><instance_geometry "
         "url=\"#g\"/></node></visual_scene>"
         "</library_visual_scenes><scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>";
}

TEST(Collada, unit_axis_and_nodes) {
  const Asset asset = load_text("a.dae", collada());
  const auto box = bounds(asset.mesh);
  EXPECT_VEC3_NEAR(box.min(), Vec3f(0, 0.254f, 0), 1e-6f);
  EXPECT_VEC3_NEAR(box.max(), Vec3f(0.0254f, 0.2794f, 0), 1e-6f);
}

TEST(Collada, up_overrules_the_file) {
  const auto box = bounds(load_text("a.dae", collada("<up_axis>Y_UP</up_axis>"), {.up = UpAxis::z, .scale = {}}).mesh);
  EXPECT_VEC3_NEAR(box.max(), Vec3f(1, 11, 0), 1e-5f);
}

TEST(Collada, what_is_left_out_is_named) {
  std::string text = collada();
  text.insert(text.find("<library_geometries>"),
              "<library_cameras><camera id=\"c\"><optics><technique_common><perspective><xfov>40</xfov></perspective></technique_common>"
              "</optics></camera></library_cameras>");
  text.insert(text.find("</node>"), "<instance_camera url=\"#c\"/>");
  EXPECT_TRUE(has_repair(load_text("a.dae", text).repairs, "left out 1 cameras"));
}

// Appearance ---------------------------------------------------------------------------------------------------------------------------

// A triangle of one mesh on each of two nodes, the second moved by 5 along x.
Scene two_triangles() {
  Scene scene;
  for (const char* name : {"head", "hat"}) {
    Scene::Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.faces = {{VertexId{0}, VertexId{1}, VertexId{2}}};
    scene.nodes.push_back({name, std::nullopt, Eigen::Affine3d(Eigen::Translation3d(scene.nodes.empty() ? 0.0 : 5.0, 0, 0))});
    scene.instances.push_back({scene.meshes.size(), scene.meshes.size(), std::nullopt});
    scene.meshes.push_back(std::move(mesh));
  }
  return scene;
}

gltf::Json saved(Scene scene, const std::filesystem::path& path) {
  Asset asset;
  SourceDocument source;
  source.instances = assemble(scene, {}, asset);
  source.appearance = merged_appearance(scene, source.instances);
  asset.source = std::make_shared<const SourceDocument>(std::move(source));
  save_as_glb(path, asset);
  return read_document(path).json;
}

TEST(Appearance, morphs_go_to_the_objects_that_they_move) {
  const TemporaryFolder folder;
  Scene scene = two_triangles();
  scene.nodes[0].world.scale(2.0);
  scene.meshes[0].morphs = {{"smile", {{0, 0, 0}, {0, 0, 0.5f}, {0, 0, 0}}}, {"blink", {{1, 0, 0}, {0, 0, 0}, {0, 0, 0}}}};
  scene.meshes[1].morphs = {{"blink", {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}}};
  const auto json = saved(scene, folder / "a.glb");
  ASSERT_EQ(json["meshes"].size(), 2u);
  EXPECT_EQ(json["meshes"][0]["name"], "head");
  EXPECT_EQ(json["meshes"][0]["extras"]["targetNames"], gltf::Json({"smile", "blink"}));
  EXPECT_EQ(json["meshes"][0]["weights"], gltf::Json({0.0, 0.0}));
  const auto& targets = json["meshes"][0]["primitives"][0]["targets"];
  ASSERT_EQ(targets.size(), 2u);
  EXPECT_EQ(json["accessors"][targets[0]["POSITION"].get<std::size_t>()]["max"], gltf::Json({0.0, 0.0, 1.0}));
  EXPECT_FALSE(json["meshes"][1].contains("extras"));
  EXPECT_FALSE(json["meshes"][1]["primitives"][0].contains("targets"));
}

TEST(Appearance, all_sets_of_texture_coordinates_come_out) {
  const TemporaryFolder folder;
  Scene scene = two_triangles();
  scene.meshes[0].texture_coordinates = {{{0, 0}, {1, 0}, {0, 1}}, {{0, 1, 2}}};
  scene.meshes[0].coordinates_after = {{{0.5f, 0}, {0, 0.5f}, {0, 0}}};
  scene.materials.resize(1);
  scene.materials[0].normals.image = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  scene.materials[0].normals.coordinate_set = 1;
  for (Scene::Mesh& mesh : scene.meshes) mesh.face_materials = {0};
  const auto json = saved(scene, folder / "a.glb");
  for (const auto& mesh : json["meshes"]) EXPECT_TRUE(mesh["primitives"][0]["attributes"].contains("TEXCOORD_1"));
  EXPECT_EQ(json["materials"].size(), 1u) << "both meshes share it";
  EXPECT_EQ(json["materials"][0]["normalTexture"]["texCoord"], 1);
}

TEST(Appearance, a_scene_comes_through_the_process_apart_as_it_was) {
  Scene scene = two_triangles();
  scene.meshes[0].morphs = {{"smile", {{0, 0, 0}, {0, 0, 0.5f}, {0, 0, 0}}}};
  scene.meshes[0].coordinates_after = {{{0.5f, 0}, {0, 0.5f}, {0, 0}}};
  scene.meshes[1].objects = {"hat"};
  scene.materials.resize(1);
  scene.materials[0].normals.coordinate_set = 1;
  scene.materials[0].metallic = 0.5f;
  std::vector<std::string> repairs;
  Bytes bytes = to_bytes(scene, repairs);
  Scene back = scene_of_bytes(bytes, repairs);
  EXPECT_EQ(back.meshes[0].morphs[0].offsets, scene.meshes[0].morphs[0].offsets);
  EXPECT_EQ(back.materials[0].metallic, 0.5f);
  EXPECT_EQ(to_bytes(back, repairs), bytes);
}

TEST(Appearance, a_rig_that_is_replaced_is_told) {
  const TemporaryFolder folder;
  write(folder / "a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  const Asset asset = load(write(folder / "a.txt", kRig));
  EXPECT_TRUE(has_repair(save_as_glb(folder / "a.glb", asset), "replaced the rig that the asset had (2 joints)"));
  EXPECT_THAT(save_weights(folder / "b.glb", asset, *asset.weights), testing::IsEmpty());
}

// Upright ------------------------------------------------------------------------------------------------------------------------------

TEST(TurnUpright, is_what_asking_for_z_up_gives) {
  const std::string text = "v 0 0 0\nv 1 0 0\nv 0 0 2\nvn 0 -1 0\nf 1//1 2//1 3//1\n";
  Asset turned = load_text("a.obj", text);
  ASSERT_TRUE(turn_upright(turned));
  const Asset asked = load_text("a.obj", text, {.up = UpAxis::z, .scale = {}});
  EXPECT_EQ(turned.up, asked.up);
  EXPECT_EQ(turned.mesh.positions, asked.mesh.positions);
  EXPECT_EQ(turned.source->appearance->normals.values, asked.source->appearance->normals.values);
  EXPECT_EQ(turned.source->appearance->normals.values.front(), Vec3f(0, 0, 1));
}

TEST(TurnUpright, turns_the_skeleton_too) {
  const TemporaryFolder folder;
  write(folder / "a.obj", "v 0 0 0\nv 1 0 0\nv 0 0 2\nf 1 2 3\n");
  Asset asset = load(write(folder / "a.txt", "joints a 0 0 1\nroot a\nskin 0 a 1\nskin 1 a 1\nskin 2 a 1\n"));
  ASSERT_TRUE(turn_upright(asset));
  EXPECT_EQ(asset.skeleton->rest_positions[JointId{0}], Vec3f(0, 1, 0));
}

TEST(TurnUpright, leaves_a_glTF_as_it_is) {
  const TemporaryFolder folder;
  Asset asset = load(write_document(folder / "a.glb", tetrahedron_document()));
  EXPECT_FALSE(turn_upright(asset));
  EXPECT_EQ(asset.up, UpAxis::y);
  EXPECT_EQ(asset.mesh.positions.raw(), kCorners);
}

}  // namespace
}  // namespace osteon::io
