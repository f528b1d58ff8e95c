// SPDX-License-Identifier: Apache-2.0
// The main job, run as users run it, with the weights that are shipped.
#include <algorithm>
#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>

#include "osteon/base/random.h"
#include "osteon/io/save.h"
#include "osteon/program.h"
#include "osteon/synth/character.h"

namespace osteon {
namespace {

using test::osteon;
using testing::HasSubstr;

class RigCommand : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::getenv("OSTEON_MODELS") && !std::filesystem::exists(OSTEON_MODELS_FOLDER "/rignet"))
      GTEST_SKIP() << "models/rignet is not there";
    mesh_ = synth::make_character(synth::Kind::Biped, 3, {96, synth::Finish::Smooth}).mesh;
    io::save_obj(folder_ / "hero.obj", mesh_);
  }

  test::TemporaryFolder folder_;
  TriangleMesh mesh_;
};

TEST_F(RigCommand, writes_a_rig_a_picture_and_a_report) {
  const auto run = osteon(folder_, "rig hero.obj -o hero.glb --preview hero.png --report hero.json");
  ASSERT_EQ(run.code, 0) << run.err;
  const io::Asset asset = io::load(folder_ / "hero.glb");
  ASSERT_TRUE(asset.skeleton && asset.weights);
  EXPECT_GE(asset.skeleton->size(), 10u);
  EXPECT_LE(asset.weights->max_influences(), 4u);
  EXPECT_EQ(asset.mesh.positions.size(), mesh_.positions.size());
  EXPECT_THAT(test::content(folder_ / "hero.json"), HasSubstr("\"confidence\""));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "hero.png"));
}

TEST_F(RigCommand, the_same_bytes_with_one_and_two_threads) {
  ASSERT_EQ(osteon(folder_, "rig hero.obj -o one.glb --threads 1").code, 0);
  ASSERT_EQ(osteon(folder_, "rig hero.obj -o two.glb --threads 2").code, 0);
  EXPECT_TRUE(test::content(folder_ / "one.glb") == test::content(folder_ / "two.glb"));
}

bool has_joint(const io::Asset& asset, const std::string& name) { return std::ranges::count(asset.skeleton->names, name) == 1; }

TEST_F(RigCommand, hands_have_fingers_unless_they_are_not_wanted) {
  io::save_obj(folder_ / "fingers.obj", synth::make_character(synth::Kind::Biped, 8, {256, synth::Finish::Smooth}).mesh);
  const auto rigged = [&](const std::string& options) {
    const auto run = osteon(folder_, "rig fingers.obj -o fingers.glb " + options);
    EXPECT_EQ(run.code, 0) << run.err;
    return io::load(folder_ / "fingers.glb");
  };
  const io::Asset both = rigged("");
  for (const char* side : {"left_", "right_"}) {
    EXPECT_TRUE(has_joint(both, std::string(side) + "hand"));
    for (const char* finger : {"thumb_1", "thumb_3", "index_1", "middle_2", "ring_3"})
      EXPECT_TRUE(has_joint(both, side + std::string(finger)));
  }
  const io::Asset off = rigged("--fingers off"), coarse = rigged("--detail 0.3"), few = rigged("--joints 20"), many = rigged("--joints 50");
  const io::Asset wide = rigged("--bandwidth 0.08");
  for (const io::Asset* without : {&off, &coarse, &few, &wide}) EXPECT_FALSE(has_joint(*without, "left_hand"));
  EXPECT_LT(off.skeleton->size(), both.skeleton->size());
  EXPECT_TRUE(has_joint(many, "left_index_1"));  // counted among the joints that are asked for
  EXPECT_NEAR(static_cast<double>(many.skeleton->size()), 50.0, 2.0);
}

TEST_F(RigCommand, whether_it_is_a_character_does_not_depend_on_the_joints_that_are_wished) {
  for (const char* wish : {"--detail 0", "--detail 1", "--joints 5", "--joints 90"}) {
    const auto run = osteon(folder_, "rig hero.obj -o wished.glb --report wished.json " + std::string(wish));
    EXPECT_EQ(run.code, 0) << wish << ": " << run.err;
    const auto report = nlohmann::json::parse(test::content(folder_ / "wished.json"));
    EXPECT_GT(report.at("character").get<double>(), 0.5) << wish;
  }
}

// The same mesh with its vertices and faces in another order.
TriangleMesh shuffled(const TriangleMesh& mesh, Random& random) {
  std::vector<std::size_t> order(mesh.positions.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  random.shuffle(std::span(order));
  TriangleMesh out;
  PerVertex<VertexId> moved(mesh.positions.size());
  for (const std::size_t v : order) moved[static_cast<VertexId>(v)] = out.positions.push_back(mesh.positions.raw()[v]);
  for (const Triangle& t : mesh.faces) out.faces.push_back({moved[t[0]], moved[t[1]], moved[t[2]]});
  random.shuffle(std::span(out.faces.raw()));
  return out;
}

// Weights by place; the places of a synthetic character are all different.
std::map<std::array<float, 3>, std::vector<Influence>> weights_by_place(const io::Asset& asset) {
  std::map<std::array<float, 3>, std::vector<Influence>> out;
  for (const VertexId v : asset.mesh.positions.ids()) {
    const Vec3f& p = asset.mesh.positions[v];
    const auto row = (*asset.weights)[v];
    out[{p.x(), p.y(), p.z()}] = {row.begin(), row.end()};
  }
  return out;
}

TEST_F(RigCommand, the_same_rig_for_any_order_of_vertices) {
  Random random(7);
  io::save_obj(folder_ / "shuffled.obj", shuffled(mesh_, random));
  ASSERT_EQ(osteon(folder_, "rig hero.obj -o hero.glb").code, 0);
  ASSERT_EQ(osteon(folder_, "rig shuffled.obj -o shuffled.glb").code, 0);

  const io::Asset a = io::load(folder_ / "hero.glb"), b = io::load(folder_ / "shuffled.glb");
  EXPECT_EQ(a.skeleton->names, b.skeleton->names);
  EXPECT_EQ(a.skeleton->parents, b.skeleton->parents);
  EXPECT_EQ(a.skeleton->rest_positions, b.skeleton->rest_positions);
  EXPECT_EQ(weights_by_place(a).size(), mesh_.positions.size());
  EXPECT_TRUE(weights_by_place(a) == weights_by_place(b));
}

TriangleMesh with_z_up(TriangleMesh mesh) {
  for (Vec3f& p : mesh.positions) p = Vec3f(p.x(), -p.z(), p.y());
  return mesh;
}

TEST_F(RigCommand, a_character_that_stands_on_z_comes_out_upright_with_the_same_rig) {
  io::save_obj(folder_ / "z.obj", with_z_up(mesh_));
  ASSERT_EQ(osteon(folder_, "rig hero.obj -o hero.glb --report hero.json").code, 0);
  const auto run = osteon(folder_, "rig z.obj -o z.glb --report z.json");
  ASSERT_EQ(run.code, 0);
  EXPECT_THAT(run.err, HasSubstr("turned upright"));
  ASSERT_EQ(osteon(folder_, "rig z.obj -o told.glb --up z --report told.json").code, 0);
  EXPECT_THAT(test::content(folder_ / "hero.json"), HasSubstr("\"up\": \"y\""));
  EXPECT_THAT(test::content(folder_ / "z.json"), HasSubstr("\"up\": \"z\""));
  EXPECT_THAT(test::content(folder_ / "told.json"), HasSubstr("\"up\": \"z\""));

  for (const char* file : {"z.glb", "told.glb"}) {
    const io::Asset hero = io::load(folder_ / "hero.glb"), z = io::load(folder_ / file);
    EXPECT_EQ(z.mesh.positions, hero.mesh.positions) << file;
    EXPECT_EQ(z.skeleton->names, hero.skeleton->names);
    EXPECT_EQ(z.skeleton->parents, hero.skeleton->parents);
    EXPECT_EQ(z.skeleton->rest_positions, hero.skeleton->rest_positions);
    EXPECT_TRUE(*z.weights == *hero.weights);
  }
}

TEST_F(RigCommand, a_glTF_that_stands_on_z_keeps_its_frame_unless_told_otherwise) {
  io::Asset asset;
  asset.mesh = with_z_up(mesh_);
  Skeleton stick;
  stick.add("stick", std::nullopt, {0, 0, 0.5f});
  SkinWeights weights;
  const Influence whole{JointId{0}, 1.0f};
  for (std::size_t v = 0; v < asset.mesh.positions.size(); ++v) weights.append({&whole, 1});
  io::save_glb(folder_ / "z.glb", asset, stick, weights);
  ASSERT_EQ(osteon(folder_, "rig hero.obj -o hero.glb").code, 0);
  const auto run = osteon(folder_, "rig z.glb -o kept.glb --report kept.json");
  ASSERT_EQ(run.code, 0);
  EXPECT_THAT(run.err, HasSubstr("a glTF keeps its frame"));
  EXPECT_THAT(test::content(folder_ / "kept.json"), HasSubstr("\"up\": \"z\""));
  ASSERT_EQ(osteon(folder_, "rig z.glb -o turned.glb --up z").code, 0);
  const io::Asset hero = io::load(folder_ / "hero.glb"), kept = io::load(folder_ / "kept.glb"), turned = io::load(folder_ / "turned.glb");
  EXPECT_EQ(kept.mesh.positions, asset.mesh.positions);
  for (const JointId j : hero.skeleton->names.ids()) {
    const Vec3f& p = hero.skeleton->rest_positions[j];
    EXPECT_VEC3_NEAR(kept.skeleton->rest_positions[j], Vec3f(p.x(), -p.z(), p.y()), 1e-5f);
    EXPECT_VEC3_NEAR(turned.skeleton->rest_positions[j], p, 1e-5f);
  }
}

TEST_F(RigCommand, a_fish_around_the_origin_is_told_upright_by_how_clearly_it_is_seen) {
  TriangleMesh fish = synth::make_character(synth::Kind::Fish, 3, {82, synth::Finish::Smooth}).mesh;
  const Vec3f middle = bounds(fish).center();
  for (Vec3f& p : fish.positions) p -= middle;
  io::save_obj(folder_ / "y.obj", fish);
  io::save_obj(folder_ / "z.obj", with_z_up(fish));
  ASSERT_EQ(osteon(folder_, "rig y.obj -o y.glb --report y.json").code, 0);
  const auto run = osteon(folder_, "rig z.obj -o z.glb --report z.json");
  ASSERT_EQ(run.code, 0);
  EXPECT_THAT(run.err, HasSubstr("does not tell the up axis"));
  EXPECT_THAT(test::content(folder_ / "y.json"), HasSubstr("\"up\": \"y\""));
  EXPECT_THAT(test::content(folder_ / "z.json"), HasSubstr("\"up\": \"z\""));
  const io::Asset y = io::load(folder_ / "y.glb"), z = io::load(folder_ / "z.glb");
  EXPECT_EQ(z.skeleton->names, y.skeleton->names);
  EXPECT_TRUE(*z.weights == *y.weights);
  EXPECT_EQ(z.mesh.positions, y.mesh.positions);
  for (const JointId j : y.skeleton->names.ids()) EXPECT_VEC3_NEAR(z.skeleton->rest_positions[j], y.skeleton->rest_positions[j], 1e-5f);
}

TEST_F(RigCommand, a_given_skeleton_is_kept) {
  const Rig puppet = synth::make_character(synth::Kind::Biped, 3, {96, synth::Finish::Smooth});
  ASSERT_EQ(osteon(folder_, "synth biped --seed 3 --smooth --cells 96 -o given.glb").code, 0);
  ASSERT_EQ(osteon(folder_, "rig hero.obj -o hero.glb --skeleton given.glb").code, 0);
  const io::Asset asset = io::load(folder_ / "hero.glb");
  EXPECT_EQ(asset.skeleton->names, puppet.skeleton.names);
  EXPECT_EQ(asset.skeleton->parents, puppet.skeleton.parents);
  for (const JointId j : puppet.skeleton.names.ids())
    EXPECT_VEC3_NEAR(asset.skeleton->rest_positions[j], puppet.skeleton.rest_positions[j], 1e-5f);
}

// As `skin` does it: the joints' nodes as they are in their file, but for the node above them that brings them to the body.
TEST_F(RigCommand, a_given_skeleton_goes_out_as_it_is_also_from_other_units) {
  const Rig puppet = synth::make_character(synth::Kind::Biped, 3, {96, synth::Finish::Smooth});
  io::Asset large;
  large.mesh = puppet.mesh;
  Skeleton skeleton = puppet.skeleton;
  for (Vec3f& p : large.mesh.positions) p *= 100.0f;
  for (Vec3f& p : skeleton.rest_positions) p *= 100.0f;
  skeleton.names[JointId{0}] = "mixamorig:Hips";
  io::SaveOptions as_given;
  as_given.names = io::JointNames::as_given;
  io::save_glb(folder_ / "large.glb", large, skeleton, puppet.weights, as_given);
  const auto run = osteon(folder_, "rig hero.obj --skeleton large.glb -o rig.glb --report rig.json");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("scaled by 0.01"));
  EXPECT_THAT(test::content(folder_ / "rig.json"), HasSubstr("scaled by 0.01"));
  ASSERT_EQ(osteon(folder_, "skin hero.obj --skeleton large.glb --method networks -o skin.glb").code, 0);
  EXPECT_TRUE(test::content(folder_ / "rig.glb") == test::content(folder_ / "skin.glb"));
  EXPECT_TRUE(has_joint(io::load(folder_ / "rig.glb"), "mixamorig:Hips"));
}

TEST_F(RigCommand, the_report_tells_what_was_mended_and_what_was_changed) {
  std::ofstream(folder_ / "hero.obj", std::ios::app) << "v nan 0 0\n";
  ASSERT_EQ(osteon(folder_, "rig hero.obj -o hero.glb --report hero.json").code, 0);
  EXPECT_THAT(test::content(folder_ / "hero.json"), HasSubstr("moved 1 vertices"));
  ASSERT_EQ(osteon(folder_, "rig hero.glb -o again.glb --report again.json").code, 0);
  EXPECT_THAT(test::content(folder_ / "again.json"), HasSubstr("replaced the rig"));
}

TEST_F(RigCommand, rig_txt_goes_out_with_its_mesh_but_never_over_the_input) {
  ASSERT_EQ(osteon(folder_, "rig hero.obj -o hero.glb --rigtxt rigged.txt").code, 0);
  const io::Asset glb = io::load(folder_ / "hero.glb"), text = io::load(folder_ / "rigged.txt");
  EXPECT_EQ(text.skeleton->names, glb.skeleton->names);
  EXPECT_EQ(text.mesh.positions.size(), glb.mesh.positions.size());

  const std::string before = test::content(folder_ / "hero.obj");
  const auto run = osteon(folder_, "rig hero.obj -o hero.glb --rigtxt hero.txt");
  EXPECT_EQ(run.code, 2);
  EXPECT_THAT(run.err, HasSubstr("would be overwritten"));
  EXPECT_TRUE(test::content(folder_ / "hero.obj") == before);
}

TEST_F(RigCommand, below_the_wanted_confidence_nothing_is_written_and_the_code_is_3) {
  const auto run = osteon(folder_, "rig hero.obj -o hero.glb --min-confidence 1 --report hero.json");
  EXPECT_EQ(run.code, 3);
  EXPECT_THAT(run.err, HasSubstr("the confidence in this rig is"));
  EXPECT_FALSE(std::filesystem::exists(folder_ / "hero.glb"));
  EXPECT_TRUE(std::filesystem::exists(folder_ / "hero.json"));
}

TEST_F(RigCommand, a_mesh_that_cannot_be_rigged_is_named) {
  std::ofstream(folder_ / "bad.obj") << "v 0 0 0\nv 1 x 0\nv 0 1 0\nf 1 2 3\n";
  for (const char* command : {"rig bad.obj", "skin bad.obj --skeleton hero.glb"}) {
    if (command[0] == 's') ASSERT_EQ(osteon(folder_, "rig hero.obj -o hero.glb").code, 0);
    const auto run = osteon(folder_, std::string(command) + " -o out.glb");
    EXPECT_EQ(run.code, 2);
    EXPECT_THAT(run.err, HasSubstr("error: bad.obj: the mesh has ")) << command;
  }
}

}  // namespace
}  // namespace osteon
