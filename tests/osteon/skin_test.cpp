// SPDX-License-Identifier: Apache-2.0
// A mesh bound to a skeleton that is there already, as users do it.
#ifdef OSTEON_HAVE_ASSIMP
#include <assimp/scene.h>

#include <assimp/Exporter.hpp>
#include <assimp/Importer.hpp>
#endif

#include <cstring>
#include <map>
#include <nlohmann/json.hpp>

#include "osteon/base/error.h"
#include "osteon/io/save.h"
#include "osteon/program.h"
#include "osteon/synth/character.h"

namespace osteon {
namespace {

using test::osteon;
using testing::HasSubstr;
using Json = nlohmann::json;

Json document_of(const std::filesystem::path& glb) {
  const std::string bytes = test::content(glb);
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data() + 12, 4);
  return Json::parse(bytes.substr(20, length));
}

// The same file with another JSON part.
void rewrite(const std::filesystem::path& glb, const Json& json) {
  const std::string bytes = test::content(glb);
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data() + 12, 4);
  std::string text = json.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  std::string out = bytes.substr(0, 12) + std::string(8, 0) + text + bytes.substr(20 + length);
  const auto put = [&](std::size_t at, std::size_t value) {
    const auto number = static_cast<std::uint32_t>(value);
    std::memcpy(out.data() + at, &number, 4);
  };
  put(8, out.size());
  put(12, text.size());
  std::memcpy(out.data() + 16, "JSON", 4);
  std::ofstream(glb, std::ios::binary) << out;
}

// The joints of the first skin, each as its node is in the file but for the numbers of its children.
std::vector<Json> joints_of(const Json& document) {
  std::vector<Json> out;
  for (const Json& joint : document["skins"][0]["joints"]) {
    Json node = document["nodes"][joint.get<std::size_t>()];
    if (node.contains("children")) {
      Json names = Json::array();
      for (const Json& child : node["children"]) names.push_back(document["nodes"][child.get<std::size_t>()]["name"]);
      node["children"] = names;
    }
    out.push_back(node);
  }
  return out;
}

class SkinCommand : public testing::Test {
 protected:
  void SetUp() override {
    rig_ = synth::make_character(synth::Kind::Biped, 3, {48, synth::Finish::Smooth});
    io::Asset asset;
    asset.mesh = rig_.mesh;
    io::save_glb(folder_ / "hero.glb", asset, rig_.skeleton, rig_.weights);
    Json json = document_of(folder_ / "hero.glb");
    for (const Json& joint : json["skins"][0]["joints"]) {  // what only an artist's own file has
      Json& node = json["nodes"][joint.get<std::size_t>()];
      node["name"] = "mixamorig:" + node["name"].get<std::string>();
      node["extras"] = {{"stretch", 0.1}, {"label", "r\u00fcckgrat"}};
      node["scale"] = {1.0, 1.0, 1.0};
    }
    rewrite(folder_ / "hero.glb", json);
    io::save_obj(folder_ / "body.obj", rig_.mesh);
  }

  test::TemporaryFolder folder_;
  Rig rig_;
};

TEST_F(SkinCommand, binds_a_bare_mesh_to_the_skeleton_of_another_file_and_leaves_it_as_it_was) {
  const auto run = osteon(folder_, "skin body.obj --skeleton hero.glb -o out.glb --report out.json");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_EQ(joints_of(document_of(folder_ / "out.glb")), joints_of(document_of(folder_ / "hero.glb")));
  const io::Asset in = io::load(folder_ / "hero.glb"), out = io::load(folder_ / "out.glb");
  EXPECT_EQ(out.skeleton->names, in.skeleton->names);
  EXPECT_EQ(out.skeleton->rest_positions, in.skeleton->rest_positions);
  ASSERT_TRUE(out.weights);
  EXPECT_EQ(out.mesh.positions, rig_.mesh.positions);
  const Json report = Json::parse(test::content(folder_ / "out.json"));
  EXPECT_EQ(report["unweighted_vertices"], 0);
  EXPECT_GT(report["coverage"], 0.9);
  EXPECT_EQ(report["worst_joints"].size(), 5u);
}

TEST_F(SkinCommand, the_characters_own_skeleton_keeps_its_bytes) {
  const auto run = osteon(folder_, "skin hero.glb -o out.glb");
  ASSERT_EQ(run.code, 0) << run.err;
  const Json before = document_of(folder_ / "hero.glb"), after = document_of(folder_ / "out.glb");
  EXPECT_EQ(after["nodes"], before["nodes"]);
  EXPECT_EQ(after["skins"][0]["joints"], before["skins"][0]["joints"]);
  EXPECT_EQ(io::load(folder_ / "out.glb").skeleton->rest_orientations, io::load(folder_ / "hero.glb").skeleton->rest_orientations);
}

#ifdef OSTEON_HAVE_ASSIMP
// Assimp writes the FBX, as another program would.
TEST_F(SkinCommand, the_skeleton_of_an_fbx_stays_as_it_was_read_but_for_rounding) {
  Assimp::Importer importer;
  Assimp::Exporter exporter;
  const aiScene* scene = importer.ReadFile((folder_ / "hero.glb").string(), 0);
  ASSERT_TRUE(scene) << importer.GetErrorString();
  ASSERT_EQ(exporter.Export(scene, "fbxa", (folder_ / "hero.fbx").string()), aiReturn_SUCCESS) << exporter.GetErrorString();
  const auto run = osteon(folder_, "skin body.obj --skeleton hero.fbx -o out.glb");
  ASSERT_EQ(run.code, 0) << run.err;
  const Skeleton in = io::load_skeleton_file(folder_ / "hero.fbx").skeleton, out = *io::load(folder_ / "out.glb").skeleton;
  EXPECT_EQ(out.names, in.names);
  EXPECT_EQ(out.parents, in.parents);
  EXPECT_THAT(run.err, HasSubstr("scaled by 100"));  // Assimp writes metres where FBX has centimetres
  for (JointId j : out.names.ids()) {
    EXPECT_VEC3_NEAR(out.rest_positions[j], 100.0f * in.rest_positions[j], 1e-6f) << out.names[j];
    EXPECT_LT(out.rest_orientations[j].angularDistance(in.rest_orientations[j]), 2e-6f) << out.names[j];
  }
  std::map<std::string, Vec3f> artists;
  for (JointId j : rig_.skeleton.names.ids()) artists["mixamorig:" + rig_.skeleton.names[j]] = rig_.skeleton.rest_positions[j];
  ASSERT_EQ(out.size(), artists.size());
  for (JointId j : out.names.ids()) EXPECT_VEC3_NEAR(out.rest_positions[j], artists.at(out.names[j]), 1e-4f) << out.names[j];
}
#endif

TEST_F(SkinCommand, a_skeleton_in_centimetres_is_brought_to_the_body_by_one_node_above_it) {
  io::Asset asset;
  asset.mesh = rig_.mesh;
  for (Vec3f& p : asset.mesh.positions) p *= 100.0f;
  Skeleton large = rig_.skeleton;
  for (Vec3f& p : large.rest_positions) p *= 100.0f;
  io::save_glb(folder_ / "large.glb", asset, large, rig_.weights);
  const auto run = osteon(folder_, "skin body.obj --skeleton large.glb -o out.glb");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("scaled by 0.01"));
  EXPECT_EQ(joints_of(document_of(folder_ / "out.glb")), joints_of(document_of(folder_ / "large.glb")));
  const io::Asset out = io::load(folder_ / "out.glb");
  for (JointId j : rig_.skeleton.names.ids()) EXPECT_VEC3_NEAR(out.skeleton->rest_positions[j], rig_.skeleton.rest_positions[j], 1e-4f);
}

TEST_F(SkinCommand, a_bare_mesh_that_stands_on_z_is_turned_upright_to_the_skeleton) {
  TriangleMesh z_up = rig_.mesh;
  for (Vec3f& p : z_up.positions) p = Vec3f(p.x(), -p.z(), p.y());
  io::save_obj(folder_ / "z.obj", z_up);
  const auto run = osteon(folder_, "skin z.obj --skeleton hero.glb -o z.glb");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("turned upright"));
  ASSERT_EQ(osteon(folder_, "skin body.obj --skeleton hero.glb -o out.glb").code, 0);
  const io::Asset z = io::load(folder_ / "z.glb"), out = io::load(folder_ / "out.glb");
  EXPECT_EQ(z.mesh.positions, out.mesh.positions);
  EXPECT_EQ(z.skeleton->rest_positions, out.skeleton->rest_positions);
  EXPECT_TRUE(*z.weights == *out.weights);
}

TEST_F(SkinCommand, binds_by_neuroskinning_the_same_with_one_and_two_threads) {
  const auto run = osteon(folder_, "skin body.obj --skeleton hero.glb --method neuroskinning -o one.glb --report one.json --threads 1");
  ASSERT_EQ(run.code, 0) << run.err;
  ASSERT_EQ(osteon(folder_, "skin body.obj --skeleton hero.glb --method neuroskinning -o two.glb --threads 2").code, 0);
  EXPECT_TRUE(test::content(folder_ / "one.glb") == test::content(folder_ / "two.glb"));
  const Json report = Json::parse(test::content(folder_ / "one.json"));
  EXPECT_EQ(report["unweighted_vertices"], 0);
  EXPECT_EQ(report["method"], "neuroskinning");
}

TEST_F(SkinCommand, the_same_bytes_with_one_and_two_threads) {
  ASSERT_EQ(osteon(folder_, "skin body.obj --skeleton hero.glb -o one.glb --threads 1").code, 0);
  ASSERT_EQ(osteon(folder_, "skin body.obj --skeleton hero.glb -o two.glb --threads 2").code, 0);
  EXPECT_TRUE(test::content(folder_ / "one.glb") == test::content(folder_ / "two.glb"));
}

TEST_F(SkinCommand, every_method_weighs_every_vertex) {
  for (const char* method : {"rigid", "heat", "biharmonic", "neuroskinning", "transfer --from hero.glb"}) {
    const auto run = osteon(folder_, fmt::format("skin body.obj --skeleton hero.glb -o out.glb --method {}", method));
    ASSERT_EQ(run.code, 0) << run.err;
    const io::Asset out = io::load(folder_ / "out.glb");
    EXPECT_THAT(out.rig_repairs, testing::Each(testing::Not(HasSubstr("no weight")))) << method;
  }
}

TEST_F(SkinCommand, says_what_is_missing) {
  EXPECT_THAT(osteon(folder_, "skin body.obj -o out.glb").err, HasSubstr("has no skeleton"));
  EXPECT_THAT(osteon(folder_, "skin hero.glb -o out.glb --lock nobody").err, HasSubstr("nobody"));
  EXPECT_THAT(osteon(folder_, "skin hero.glb -o out.glb --method transfer").err, HasSubstr("--from"));
}

TEST_F(SkinCommand, the_report_tells_what_was_mended_and_what_was_changed) {
  std::filesystem::copy_file(folder_ / "hero.glb", folder_ / "other.glb");
  const auto run = osteon(folder_, "skin hero.glb --skeleton other.glb -o out.glb --report out.json");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(Json::parse(test::content(folder_ / "out.json"))["changes"].dump(), HasSubstr("replaced the rig"));

  std::ofstream(folder_ / "body.obj", std::ios::app) << "v nan 0 0\n";
  ASSERT_EQ(osteon(folder_, "skin body.obj --skeleton hero.glb -o out.glb --report out.json").code, 0);
  EXPECT_THAT(Json::parse(test::content(folder_ / "out.json"))["repairs"].dump(), HasSubstr("to the origin"));
}

TEST_F(SkinCommand, compare_keeps_long_names_apart) {
  const std::string name = "a_character_with_a_long_name";
  std::filesystem::copy_file(folder_ / "hero.glb", folder_ / (name + ".glb"));
  EXPECT_THAT(osteon(folder_, fmt::format("compare hero.glb {}.glb", name)).out, HasSubstr("  hero  " + name + "\n"));
}

TEST_F(SkinCommand, compare_tells_a_rig_from_a_worse_one) {
  ASSERT_EQ(osteon(folder_, "skin hero.glb -o rigid.glb --method rigid").code, 0);
  const auto run = osteon(folder_, "compare hero.glb rigid.glb --json both.json --picture both.png");
  ASSERT_EQ(run.code, 0) << run.err;
  const Json both = Json::parse(test::content(folder_ / "both.json"));
  EXPECT_GT(both["between"]["l1"], 0.05);
  EXPECT_GT(both["b"]["roughness"], both["a"]["roughness"]);
  EXPECT_TRUE(std::filesystem::exists(folder_ / "both.png"));
  const auto same = osteon(folder_, "compare hero.glb hero.glb --json same.json");
  EXPECT_LT(Json::parse(test::content(folder_ / "same.json"))["between"]["l1"], 1e-9);
}

}  // namespace
}  // namespace osteon
