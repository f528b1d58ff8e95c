// SPDX-License-Identifier: Apache-2.0
// What OBJ, PLY, STL, DAE and FBX hold arrives; what is broken in them is in bad_input_test.cpp.
#include "files.h"
#include "osteon/io/load.h"
#include "osteon/io/rigtxt.h"
#include "osteon/io/save.h"
#include "osteon/io/source_document.h"
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
  EXPECT_EQ(appearance.materials[0].texture, folder.path() / "tex/red.png");
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

}  // namespace
}  // namespace osteon::io
