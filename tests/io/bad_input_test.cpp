// SPDX-License-Identifier: Apache-2.0
// Broken files: each is either repaired, and said so, or refused with one clear Error. Never a crash (run these under ASan and UBSan).
#include <functional>

#include "files.h"
#include "osteon/io/load.h"
#include "osteon/io/rigtxt.h"
#include "osteon/io/save.h"

namespace osteon::io {
namespace {

using namespace osteon::io::test;
using gltf::Json;

struct Broken {
  std::string name;  // of the case
  std::string file;  // its name says the format
  std::string content;
  std::string refused;   // a part of the Error; or else
  std::string repaired;  // a part of the repair
};

void PrintTo(const Broken& broken, std::ostream* out) { *out << broken.name; }

class BadInput : public testing::TestWithParam<Broken> {};

TEST_P(BadInput, is_repaired_or_refused_and_said_so) {
  const Broken& broken = GetParam();
  const TemporaryFolder folder;
  const auto path = write(folder / broken.file, broken.content);
  if (!broken.refused.empty()) {
    const std::string text = error_of([&] { load(path); });
    EXPECT_THAT(text, testing::HasSubstr(broken.refused));
    EXPECT_THAT(text, testing::HasSubstr(broken.file)) << "an Error names the file";
    return;
  }
  const Asset asset = load(path);
  std::vector<std::string> repairs = asset.repairs;
  repairs.insert(repairs.end(), asset.rig_repairs.begin(), asset.rig_repairs.end());
  EXPECT_TRUE(has_repair(repairs, broken.repaired));
  EXPECT_FALSE(asset.mesh.faces.empty());
}

const auto kName = [](const auto& info) { return info.param.name; };

// OBJ -----------------------------------------------------------------------------------------------------------------------------------

const std::string kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

INSTANTIATE_TEST_SUITE_P(
    Obj, BadInput,
    testing::Values(
        Broken{"empty", "a.obj", "", "the file is empty", ""}, Broken{"comments_only", "a.obj", "# nothing\n", "no vertices", ""},
        Broken{"no_faces", "a.obj", kTriangle, "3 vertices, but no faces", ""},
        Broken{"faces_only", "a.obj", "f 1 2 3\n", "no vertices", ""},
        Broken{"index_zero", "a.obj", kTriangle + "f 0 1 2\nf 1 2 3\n", "", "dropped 1 faces that are malformed, the first in line 4"},
        Broken{"index_beyond", "a.obj", kTriangle + "f 1 2 4\nf 1 2 3\n", "", "dropped 1 faces with an index beyond the 3 vertices"},
        Broken{"index_beyond_only", "a.obj", kTriangle + "f 1 2 9\n",
               "3 vertices, but no faces: dropped 1 faces with an index beyond the 3 vertices, the first in line 4 with 9", ""},
        Broken{"index_too_negative", "a.obj", kTriangle + "f -1 -2 -9\nf 1 2 3\n", "", "malformed"},
        Broken{"index_overflow", "a.obj", kTriangle + "f 1 2 99999999999999999999\nf 1 2 4294967297\nf 1 2 3\n", "",
               "dropped 2 faces that are malformed"},
        Broken{"index_garbage", "a.obj", kTriangle + "f one two three\nf 1 2 3\n", "", "malformed"},
        Broken{"index_slashes", "a.obj", kTriangle + "f / // 1///\nf 1/ 2// 3//\n", "", "malformed"},
        Broken{"two_corners", "a.obj", kTriangle + "f 1 2\nf\nf 1 2 3\n", "", "dropped 2 faces that are malformed"},
        Broken{"nan", "a.obj", "v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "", "moved 1 vertices with coordinates that are not finite"},
        Broken{"infinite", "a.obj", "v 0 0 1e999\nv 1 -inf 0\nv 0 1 0\nf 1 2 3\n", "", "moved 2 vertices"},
        Broken{"missing_coordinate", "a.obj", "v 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "", "moved 1 vertices"},
        Broken{"huge", "a.obj", "v 1e30 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "", "moved 1 vertices"},
        Broken{"lost_materials", "a.obj", "mtllib gone.mtl\n" + kTriangle + "f 1 2 3\n", "", "materials left out"},
        Broken{"binary_garbage", "a.obj", std::string("\0\1\2v\xFF\n", 6), "no vertices", ""}),
    kName);

TEST(BadObj, normals_and_coordinates_out_of_range_do_no_harm) {
  const TemporaryFolder folder;
  const Asset asset = load(write(folder / "a.obj", kTriangle + "vt 0 0\nvn nan 0 0\nf 1/9/9 2/1/1 3/-9/1\nf 1/1/9 2/1/1 3/1/1\n"));
  EXPECT_EQ(asset.mesh.faces.size(), 1u) << "-9 has no meaning";
  Skeleton skeleton;
  skeleton.add("root", std::nullopt, Vec3f(0, 0, 0));
  SkinWeights weights;
  for (int v = 0; v < 3; ++v) weights.append(std::vector<Influence>{{JointId{0}, 1.0f}});
  save_glb(folder / "a.glb", asset, skeleton, weights);
  EXPECT_EQ(load(folder / "a.glb").mesh.faces.size(), 1u);
}

TEST(BadObj, a_polygon_of_a_million_corners_is_cut_in_time) {
  std::string text;
  for (int i = 0; i < 1000000; ++i) text += i % 2 ? "v 1 0 0\n" : "v 0 1 0\n";
  text += "f";
  for (int i = 1; i <= 1000000; ++i) text += fmt::format(" {}", i);
  const TemporaryFolder folder;
  EXPECT_EQ(load(write(folder / "a.obj", text)).mesh.faces.size(), 999998u);
}

// PLY -----------------------------------------------------------------------------------------------------------------------------------

std::string ply(const std::string& elements, const std::string& data, const std::string& format = "ascii") {
  return "ply\nformat " + format + " 1.0\n" + elements + "end_header\n" + data;
}
const std::string kXyz = "property float x\nproperty float y\nproperty float z\n", kList = "property list uchar int vertex_indices\n";
const std::string kElements = "element vertex 3\n" + kXyz + "element face 1\n" + kList, kPoints = "0 0 0\n1 0 0\n0 1 0\n";

INSTANTIATE_TEST_SUITE_P(
    Ply, BadInput,
    testing::Values(
        Broken{"no_end_header", "a.ply", "ply\nformat ascii 1.0\nelement vertex 3\n", "no end_header", ""},
        Broken{"no_format", "a.ply", "ply\n" + kElements + "end_header\n" + kPoints + "3 0 1 2\n", "no format line", ""},
        Broken{"unknown_format", "a.ply", ply(kElements, "", "binary_middle_endian"), "expected ascii, binary_little_endian", ""},
        Broken{"not_ply", "a.ply", "plyx\n", "expected 'ply'", ""},
        Broken{"unknown_type", "a.ply", ply("element vertex 3\nproperty quaternion x\n", ""), "property type 'quaternion' is unknown", ""},
        Broken{"property_first", "a.ply", ply("property float x\n", ""), "a property before any element", ""},
        Broken{"negative_count", "a.ply", ply("element vertex -3\n" + kXyz, ""), "has no count", ""},
        Broken{"no_count", "a.ply", ply("element vertex\n" + kXyz, ""), "has no count", ""},
        Broken{"no_z", "a.ply", ply("element vertex 1\nproperty float x\nproperty float y\n", "0 0\n"), "no x, y and z", ""},
        Broken{"faces_without_list", "a.ply", ply("element face 1\nproperty int vertex_indices\n", "0\n"), "no list of vertex indices", ""},
        Broken{"float_list_length", "a.ply", ply("element face 1\nproperty list float int vertex_indices\n", "0\n"), "must be an integer",
               ""},
        Broken{"truncated_ascii", "a.ply", ply("element vertex 3\n" + kXyz + "element face 2\n" + kList, kPoints + "3 0 1 2\n3 0"), "",
               "the file ends early; read 3 vertices and 1 faces"},
        Broken{"truncated_vertices", "a.ply", ply(kElements, "0 0 0\n1 0"), "no faces", ""},
        Broken{"truncated_binary", "a.ply", ply(kElements, "abcdefgh", "binary_little_endian"), "no vertices", ""},
        Broken{"endless_count", "a.ply", ply("element vertex 4000000000\n" + kXyz, "abc", "binary_little_endian"), "no vertices", ""},
        Broken{"endless_empty_element", "a.ply", ply("element nothing 9000000000000000000\n" + kElements, kPoints + "3 0 1 9\n"),
               "no faces", ""},
        Broken{"index_beyond", "a.ply", ply("element vertex 3\n" + kXyz + "element face 2\n" + kList, kPoints + "3 0 1 2\n3 0 1 9\n"), "",
               "dropped 1 faces with an index beyond"},
        Broken{"index_negative", "a.ply", ply("element vertex 3\n" + kXyz + "element face 2\n" + kList, kPoints + "3 0 1 2\n3 0 1 -1\n"),
               "", "dropped 1 faces"},
        Broken{"nan", "a.ply", ply(kElements, "nan 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"), "", "moved 1 vertices"},
        Broken{"list_of_billions", "a.ply",
               ply("element vertex 3\n" + kXyz + "element face 1\nproperty list uint int vertex_indices\n", kPoints + "4000000000 0 1 2\n"),
               "no faces", ""}),
    kName);

// STL -----------------------------------------------------------------------------------------------------------------------------------

std::string stl(std::uint32_t promised, std::size_t there, std::uint8_t fill = 0) {
  std::string out(80, ' ');
  out.append(reinterpret_cast<const char*>(&promised), 4);
  return out + std::string(50 * there, static_cast<char>(fill));
}

INSTANTIATE_TEST_SUITE_P(
    Stl, BadInput,
    testing::Values(
        Broken{"empty_solid", "a.stl", "solid x\nendsolid x\n", "no vertices", ""},
        Broken{"two_vertices", "a.stl", "solid\nfacet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\nendfacet\n", "no vertices", ""},
        Broken{"cut_off", "a.stl", "solid\nfacet\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendfacet\nfacet\nvertex 0 0", "",
               "without exactly three vertices"},
        Broken{"four_vertices", "a.stl", "solid\nfacet\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nvertex 1 1 0\nendfacet\n", "",
               "without exactly three vertices"},
        Broken{"numbers_garbage", "a.stl", "solid\nfacet\nvertex a b c\nvertex 1 0 0\nvertex 0 1 0\nendfacet\n", "", "moved 1 vertices"},
        Broken{"binary_short", "a.stl", stl(9, 2), "", "the file ends early; read 2 of 9 triangles"},
        Broken{"binary_endless", "a.stl", stl(0xFFFFFFFF, 1), "", "read 1 of 4294967295"},
        Broken{"binary_none", "a.stl", stl(0, 0), "no vertices", ""},
        Broken{"binary_nan", "a.stl", stl(1, 1, 0xFF), "none of the 3 vertices is finite", ""},
        Broken{"tiny", "a.stl", "xyz", "neither a binary nor an ASCII STL", ""}),
    kName);

// glTF ----------------------------------------------------------------------------------------------------------------------------------

// The tetrahedron, skinned or not, with one thing changed, as the bytes of a GLB.
std::string glb(const std::function<void(Json&)>& change, bool skinned = false) {
  gltf::Document document = skinned ? skinned_tetrahedron_document() : tetrahedron_document();
  change(document.json);
  const auto path = std::filesystem::temp_directory_path() / fmt::format("osteon.bad_input.{}.glb", ::getpid());
  gltf::write_glb(path, document);
  const std::string bytes = read(path);
  std::filesystem::remove(path);
  return bytes;
}
std::string skinned_glb(const std::function<void(Json&)>& change) { return glb(change, true); }
std::string gltf_text(const std::string& rest) { return R"({"asset": {"version": "2.0"})" + rest + "}"; }
Json& first_primitive(Json& json) { return json["meshes"][0]["primitives"][0]; }

INSTANTIATE_TEST_SUITE_P(
    Gltf, BadInput,
    testing::Values(
        Broken{"not_json", "a.gltf", "{ oops", "malformed JSON", ""}, Broken{"no_asset", "a.gltf", "{}", "no asset", ""},
        Broken{"old_version", "a.gltf", R"({"asset": {"version": "1.0"}})", "glTF version 1.0, expected 2.x", ""},
        Broken{"nothing_in_it", "a.gltf", gltf_text(""), "no vertices", ""},
        Broken{"deep_json", "a.gltf", gltf_text(R"(, "extras": )" + std::string(100000, '[') + std::string(100000, ']')), "nested deeper",
               ""},
        Broken{"wrong_type", "a.gltf", gltf_text(R"(, "nodes": 7)"), "nodes: 7, expected an array", ""},
        Broken{"lost_buffer", "a.gltf", gltf_text(R"(, "buffers": [{"byteLength": 4, "uri": "gone.bin"}])"), "gone.bin: no such file", ""},
        Broken{"remote_buffer", "a.gltf", gltf_text(R"(, "buffers": [{"byteLength": 4, "uri": "http://x.org/a.bin"}])"),
               "expected a file beside the asset", ""},
        Broken{"absolute_buffer", "a.gltf", gltf_text(R"(, "buffers": [{"byteLength": 4, "uri": "/etc/passwd"}])"),
               "expected a file beside the asset", ""},
        Broken{"buffer_is_folder", "a.gltf", gltf_text(R"(, "buffers": [{"byteLength": 4, "uri": "."}])"), "not a regular file", ""},
        Broken{"bad_base64", "a.gltf", gltf_text(R"(, "buffers": [{"byteLength": 4, "uri": "data:;base64,!!!!"}])"), "not base64", ""},
        Broken{"short_base64", "a.gltf", gltf_text(R"(, "buffers": [{"byteLength": 40, "uri": "data:;base64,AAAA"}])"),
               "3 bytes, but byteLength says 40", ""},
        Broken{"magic_only", "a.glb", "glTF", "truncated: 4 bytes", ""},
        Broken{"version_1", "a.glb", std::string("glTF\1\0\0\0\x14\0\0\0\0\0\0\0JSON", 20), "GLB version 1, expected 2", ""},
        Broken{"trailing_bytes", "a.glb", glb([](Json&) {}) + "more", "", "ignored 4 bytes after the end"},
        Broken{"draco", "a.glb", glb([](Json& j) { j["extensionsRequired"] = {"KHR_draco_mesh_compression"}; }),
               "save the asset without compression", ""},
        Broken{"draco_primitive", "a.glb",
               glb([](Json& j) { first_primitive(j)["extensions"]["KHR_draco_mesh_compression"] = Json::object(); }), "without compression",
               ""},
        Broken{"meshopt", "a.glb", glb([](Json& j) { j["extensionsRequired"] = {"EXT_meshopt_compression"}; }), "without compression", ""},
        Broken{"node_is_its_own_child", "a.glb", glb([](Json& j) { j["nodes"][0]["children"] = {0}; }), "",
               "node 0 has another place in the tree already"},
        Broken{"node_cycle", "a.glb", glb([](Json& j) {
                 j["nodes"][0]["children"] = {1};
                 j["nodes"].push_back({{"children", {0}}});
               }),
               "", "another place in the tree"},
        Broken{"child_beyond", "a.glb", glb([](Json& j) { j["nodes"][0]["children"] = {9}; }),
               "nodes[0].children[0]: 9, but there are 1 nodes", ""},
        Broken{"root_beyond", "a.glb", glb([](Json& j) { j["scenes"][0]["nodes"] = {9}; }), "9, but there are 1 nodes", ""},
        Broken{"scene_beyond", "a.glb", glb([](Json& j) { j["scene"] = 5; }), "scene: 5, but there are 1 scenes", ""},
        Broken{"mesh_beyond", "a.glb", glb([](Json& j) { j["nodes"][0]["mesh"] = 3; }), "nodes[0].mesh: 3, but there are 1 meshes", ""},
        Broken{"mesh_negative", "a.glb", glb([](Json& j) { j["nodes"][0]["mesh"] = -1; }), "expected an integer of at least 0", ""},
        Broken{"mesh_fraction", "a.glb", glb([](Json& j) { j["nodes"][0]["mesh"] = 0.5; }), "expected an integer", ""},
        Broken{"mesh_text", "a.glb", glb([](Json& j) { j["nodes"][0]["mesh"] = "0"; }), "expected an integer", ""},
        Broken{"zero_rotation", "a.glb", glb([](Json& j) {
                 j["nodes"][0]["rotation"] = {0, 0, 0, 0};
               }),
               "expected a unit quaternion", ""},
        Broken{"short_translation", "a.glb", glb([](Json& j) {
                 j["nodes"][0]["translation"] = {0, 0};
               }),
               "2 numbers, expected 3", ""},
        Broken{"huge_scale", "a.glb", glb([](Json& j) {
                 j["nodes"][0]["scale"] = {1e300, 1, 1};
               }),
               "", "not finite in world space"},
        Broken{"null_scale", "a.glb", glb([](Json& j) { j["nodes"][0]["scale"] = nullptr; }), "expected an array", ""},
        Broken{"no_primitives", "a.glb", glb([](Json& j) { j["meshes"][0].erase("primitives"); }), "meshes[0]: no primitives", ""},
        Broken{"no_position", "a.glb", glb([](Json& j) { first_primitive(j)["attributes"].erase("POSITION"); }), "no vertices", ""},
        Broken{"mode_beyond", "a.glb", glb([](Json& j) { first_primitive(j)["mode"] = 7; }), "mode: 7, expected 0 to 6", ""},
        Broken{"points", "a.glb", glb([](Json& j) { first_primitive(j)["mode"] = 0; }), "4 vertices, but no faces", ""},
        Broken{"accessor_beyond", "a.glb", glb([](Json& j) { first_primitive(j)["attributes"]["POSITION"] = 99; }),
               "99, but there are 4 accessors", ""},
        Broken{"position_of_scalars", "a.glb", glb([](Json& j) { j["accessors"][0]["type"] = "SCALAR"; }), "expected 3 for POSITION", ""},
        Broken{"indices_of_floats", "a.glb", glb([](Json& j) { first_primitive(j)["indices"] = 0; }), "expected 1 for indices", ""},
        Broken{"float_indices", "a.glb", glb([](Json& j) {
                 j["accessors"][3]["componentType"] = 5126;
                 j["accessors"][3]["count"] = 3;
               }),
               "expected an unsigned integer", ""},
        Broken{"unknown_component", "a.glb", glb([](Json& j) { j["accessors"][0]["componentType"] = 5124; }), "5124, expected 5120", ""},
        Broken{"unknown_type", "a.glb", glb([](Json& j) { j["accessors"][0]["type"] = "VEC9"; }), "'VEC9', expected SCALAR", ""},
        Broken{"count_beyond", "a.glb", glb([](Json& j) { j["accessors"][0]["count"] = 5; }), "accessors[0]: 5 elements of 12 bytes", ""},
        Broken{"count_endless", "a.glb", glb([](Json& j) { j["accessors"][0]["count"] = 4000000000u; }), "expected at most", ""},
        Broken{"count_overflow", "a.glb", glb([](Json& j) { j["accessors"][0]["count"] = 1537228672809129302u; }), "accessors[0].count",
               ""},
        Broken{"zeros_endless", "a.glb", glb([](Json& j) {
                 j["accessors"][0].erase("bufferView");
                 j["accessors"][0]["count"] = 33554433;
               }),
               "expected at most", ""},
        Broken{"offset_beyond", "a.glb", glb([](Json& j) { j["accessors"][0]["byteOffset"] = 4; }), "elements of 12 bytes at byte 4", ""},
        Broken{"view_beyond", "a.glb", glb([](Json& j) { j["bufferViews"][1]["byteLength"] = 100000; }), "bufferViews[1]: bytes", ""},
        Broken{"view_overflow", "a.glb", glb([](Json& j) { j["bufferViews"][1]["byteOffset"] = 9007199254740992u; }),
               "bufferViews[1]: bytes", ""},
        Broken{"view_without_buffer", "a.glb", glb([](Json& j) { j["bufferViews"][1]["buffer"] = 2; }), "2, but there are 1 buffers", ""},
        Broken{"stride_too_small", "a.glb", glb([](Json& j) { j["bufferViews"][1]["byteStride"] = 4; }),
               "byteStride: 4, expected at least 12", ""},
        Broken{"index_beyond", "a.glb", glb([](Json& j) {
                 j["accessors"][0]["count"] = 3;
                 j["accessors"][1]["count"] = 3;
               }),
               "", "dropped 3 faces with an index beyond its 3 vertices"},
        Broken{"sparse_beyond", "a.glb", glb([](Json& j) {
                 j["accessors"][0]["sparse"] = {{"count", 5}};
               }),
               "5, but the accessor has 4 elements", ""},
        Broken{"sparse_index_beyond", "a.glb", glb([](Json& j) {
                 j["accessors"][0]["sparse"] = {
                     {"count", 1}, {"indices", {{"bufferView", 0}, {"componentType", 5125}}}, {"values", {{"bufferView", 1}}}};
               }),
               "but the accessor has 4 elements", ""},
        Broken{"skin_beyond", "a.glb", skinned_glb([](Json& j) { j["nodes"][0]["skin"] = 4; }), "nodes[0].skin: 4, but there are 1 skins",
               ""},
        Broken{"joint_beyond", "a.glb", skinned_glb([](Json& j) {
                 j["skins"][0]["joints"] = {1, 70};
               }),
               "70, but there are 3 nodes", ""},
        Broken{"no_joints", "a.glb", skinned_glb([](Json& j) { j["skins"][0]["joints"] = Json::array(); }), "skin 0 has no joints", ""},
        Broken{"joint_twice", "a.glb", skinned_glb([](Json& j) {
                 j["skins"][0]["joints"] = {1, 2, 1};
                 j["skins"][0].erase("inverseBindMatrices");
                 j["nodes"][2]["name"] = "hip";
               }),
               "", "1 joints had no name, or that of another"},
        Broken{"too_few_matrices", "a.glb", skinned_glb([](Json& j) {
                 j["skins"][0]["joints"] = {1, 2, 0};
               }),
               "expected 3 of 16", ""},
        Broken{"matrices_of_others", "a.glb", skinned_glb([](Json& j) { j["skins"][0]["inverseBindMatrices"] = 0; }), "expected 2 of 16",
               ""},
        Broken{"weights_of_few", "a.glb", skinned_glb([](Json& j) { j["accessors"][5]["count"] = 2; }), "expected 4 of 4", ""},
        Broken{"weight_of_unknown_joint", "a.glb", skinned_glb([](Json& j) { j["skins"][0]["joints"] = {1}; }), "",
               "weights name joints that their skin does not have"},
        Broken{"no_weights", "a.glb", skinned_glb([](Json& j) { first_primitive(j)["attributes"].erase("WEIGHTS_0"); }), "",
               "has a skin but no weights"},
        Broken{"flat_joint", "a.glb", skinned_glb([](Json& j) {
                 j["nodes"][2]["scale"] = {0, 0, 0};
               }),
               "", "singular transform"},
        Broken{"not_utf8", "a.gltf", gltf_text(", \"extras\": \"\xFF\""), "malformed JSON", ""}),
    kName);

// Others --------------------------------------------------------------------------------------------------------------------------------

INSTANTIATE_TEST_SUITE_P(
    RigText, BadInput,
    testing::Values(Broken{"no_joints", "a.txt", "root a\nhier a b\n", "no joints", ""},
                    Broken{"no_position", "a.txt", "joints a 0 0\nroot a\n", "line 1: expected joints NAME X Y Z", ""},
                    Broken{"joint_twice", "a.txt", "joints a 0 0 0\njoints a 1 0 0\n", "line 2: joint 'a' is there twice", ""},
                    Broken{"unknown_parent", "a.txt", "joints a 0 0 0\nhier x a\n", "line 2: there is no joint 'x'", ""},
                    Broken{"two_parents", "a.txt", "joints a 0 0 0\njoints b 0 0 0\njoints c 0 0 0\nhier a c\nhier b c\n",
                           "joint 'c' has two parents", ""},
                    Broken{"two_roots", "a.txt", "joints a 0 0 0\njoints b 0 0 0\nroot a\n", "2 joints without a parent, expected 1", ""},
                    Broken{"cycle", "a.txt", "joints a 0 0 0\njoints b 0 0 0\njoints c 0 0 0\nhier b c\nhier c b\n",
                           "2 joints are not below the root", ""},
                    Broken{"only_a_cycle", "a.txt", "joints b 0 0 0\njoints c 0 0 0\nhier b c\nhier c b\n", "0 joints without a parent",
                           ""},
                    Broken{"wrong_root", "a.txt", "joints a 0 0 0\njoints b 0 0 0\nhier a b\nroot b\n", "the root 'b' has a parent", ""},
                    Broken{"nan", "a.txt", "joints a nan 0 0\n", "expected joints NAME X Y Z", ""},
                    Broken{"weight_missing", "a.txt", "joints a 0 0 0\nskin 0 a\n", "joint 'a' has no weight", ""},
                    Broken{"negative_vertex", "a.txt", "joints a 0 0 0\nskin -1 a 1\n", "expected skin VERTEX JOINT WEIGHT", ""},
                    Broken{"no_mesh_beside", "a.txt", "joints a 0 0 0\nroot a\n", "no vertices", ""}),
    kName);

TEST(BadRigText, vertices_without_a_line_and_lines_without_a_vertex_are_told) {
  const TemporaryFolder folder;
  std::vector<std::string> repairs;
  const RigText rig = load_rigtxt(write(folder / "a.txt", "joints a 0 0 0\nskin 0 a 1\nskin 9000000000 a 1\n"), 3, repairs);
  EXPECT_EQ(rig.weights->size(), 3u);
  EXPECT_TRUE(has_repair(repairs, "2 vertices have no weight"));
  EXPECT_TRUE(has_repair(repairs, "but the mesh has 3; dropped"));
}

INSTANTIATE_TEST_SUITE_P(
    Others, BadInput,
    testing::Values(Broken{"fbx_cut_off", "a.fbx", std::string("Kaydara FBX Binary  \0\x1a\0\xe8\x1c\0\0\xff\xff\xff", 30), "a.fbx: ", ""},
                    Broken{"fbx_text_garbage", "a.fbx", "; FBX 7.3.0 project file\nObjects: {{{{{", "a.fbx: ", ""},
                    Broken{"dae_cut_off", "a.dae", "<?xml version=\"1.0\"?><COLLADA><library_geometries>", "a.dae: ", ""},
                    Broken{"dae_empty", "a.dae", "<?xml version=\"1.0\"?><COLLADA version=\"1.4.1\"></COLLADA>", "a.dae: ", ""},
                    Broken{"3ds_garbage", "a.3ds", "MM\xFF\xFF\xFF\x7F garbage", "a.3ds: ", ""},
                    Broken{"usd", "a.usda", "#usda 1.0\n", "USD; expected GLB, glTF", ""},
                    Broken{"zip", "a.usdz", "PK\x03\x04....", "an archive", ""}, Broken{"picture", "a.glb", "\x89PNG\r\n", "a picture", ""},
                    Broken{"blend", "a.blend", "BLENDER-v300", "export it as GLB", ""},
                    Broken{"unknown", "a.dat", "what is this", "unknown format", ""}),
    kName);

TEST(BadPath, what_is_no_file_is_refused) {
  const TemporaryFolder folder;
  EXPECT_THAT(error_of([&] { load(folder / "none.glb"); }), testing::HasSubstr("none.glb: no such file"));
  EXPECT_THAT(error_of([&] { load(folder.path()); }), testing::HasSubstr("not a regular file"));
  EXPECT_THAT(error_of([&] { load(write(folder / "a.obj", kTriangle + "f 1 2 3\n"), {.up = {}, .scale = -1.0f}); }),
              testing::HasSubstr("expected a positive number"));
}

// Every file near a good one
// ----------------------------------------------------------------------------------------------------------------

// Loads, and if that works saves: what load() accepts must be good enough for that. Only an Error may come out.
void load_and_save(const std::filesystem::path& path) {
  try {
    const Asset asset = load(path);
    Skeleton skeleton;
    skeleton.add("root", std::nullopt, Vec3f(0, 0, 0));
    SkinWeights weights;
    const Influence whole{JointId{0}, 1.0f};
    for (std::size_t v = 0; v < asset.mesh.positions.size(); ++v) weights.append({&whole, 1});
    save_glb(path.string() + ".out.glb", asset, skeleton, weights);
    load(path.string() + ".out.glb");
  } catch (const Error&) {
  }
}

TEST(NearlyGood, every_truncation_of_a_glb_is_an_error) {
  const TemporaryFolder folder;
  const std::string whole = skinned_glb([](Json&) {});
  load(write(folder / "whole.glb", whole));
  for (std::size_t size = 0; size < whole.size(); ++size) {
    const auto path = write(folder / "cut.glb", whole.substr(0, size));
    EXPECT_NE(error_of([&] { load(path); }), "") << size << " bytes";
  }
}

TEST(NearlyGood, no_flipped_byte_of_a_glb_does_harm) {
  const TemporaryFolder folder;
  std::string bytes = skinned_glb([](Json& json) {
    json.erase("materials");
    first_primitive(json).erase("material");
  });
  for (std::size_t i = 0; i < bytes.size(); ++i)
    for (const unsigned char flip : {0x01, 0x80, 0xFF}) {
      bytes[i] = static_cast<char>(bytes[i] ^ flip);
      load_and_save(write(folder / "flipped.glb", bytes));
      bytes[i] = static_cast<char>(bytes[i] ^ flip);
    }
}

TEST(NearlyGood, no_truncation_or_flip_of_a_text_or_binary_mesh_does_harm) {
  const TemporaryFolder folder;
  const std::string files[][2] = {
      {"a.obj", "mtllib m.mtl\n" + kTriangle + "vt 0 1\nvn 0 0 1\nusemtl m\nf 1/1/1 2/1/1 3/1/1\nf -3//1 -2 -1/1\n"},
      {"a.ply", ply(kElements, kPoints + "3 0 1 2\n")},
      {"b.ply", ply(kElements, std::string(36, '\1') + "\3" + std::string("\0\0\0\0\1\0\0\0\2\0\0\0", 12), "binary_little_endian")},
      {"a.stl", "solid\nfacet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n"},
      {"b.stl", stl(2, 2)},
      {"a.txt", "joints a 0 0 0\njoints b 0 1 0\nroot a\nhier a b\nskin 0 a 0.5 b 0.5\nskin 1 a 1\n"}};
  for (const auto& [name, content] : files) {
    for (std::size_t size = 0; size <= content.size(); ++size) load_and_save(write(folder / name, content.substr(0, size)));
    for (std::size_t i = 0; i < content.size(); ++i)
      for (const unsigned char flip : {0x01, 0x10, 0x80}) {
        std::string bytes = content;
        bytes[i] = static_cast<char>(bytes[i] ^ flip);
        load_and_save(write(folder / name, bytes));
      }
  }
}

}  // namespace
}  // namespace osteon::io
