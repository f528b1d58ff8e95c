// SPDX-License-Identifier: Apache-2.0
// A folder of characters, with the weights that are shipped.
#include <nlohmann/json.hpp>

#include "osteon/io/save.h"
#include "osteon/program.h"
#include "osteon/synth/character.h"

namespace osteon {
namespace {

using test::content;
using test::osteon;
using testing::HasSubstr;
namespace fs = std::filesystem;

class BatchCommand : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::getenv("OSTEON_MODELS") && !fs::exists(OSTEON_MODELS_FOLDER "/rignet")) GTEST_SKIP() << "models/rignet is not there";
    fs::create_directories(folder_ / "in/far/away");
    const auto make = [&](synth::Kind kind, const char* name) {
      io::save_obj(folder_ / name, synth::make_character(kind, 3, {40, synth::Finish::Faceted}).mesh);
    };
    make(synth::Kind::Biped, "in/hero.obj");
    make(synth::Kind::Bird, "in/far/bird.obj");
    make(synth::Kind::Fish, "in/far/away/fish.obj");
    make(synth::Kind::Quadruped, "in/horse.obj");
  }

  nlohmann::json report(const char* name) const { return nlohmann::json::parse(content(folder_ / name)); }

  test::TemporaryFolder folder_;
};

const std::vector<const char*> kRigs{"hero.glb", "horse.glb", "far/bird.glb", "far/away/fish.glb"};

TEST_F(BatchCommand, rigs_every_character_as_rig_does) {
  const auto run = osteon(folder_, "batch in -o out");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("4 of 4 files: 4 rigged, 0 refused, 0 failed, 0 of these before"));
  ASSERT_EQ(osteon(folder_, "rig in/far/bird.obj -o bird.glb").code, 0);
  EXPECT_TRUE(content(folder_ / "out/far/bird.glb") == content(folder_ / "bird.glb"));
  EXPECT_EQ(report("out/far/bird.json")["status"], "rigged");
  EXPECT_GT(report("out/far/bird.json")["joints"], 3);
  EXPECT_THAT(content(folder_ / "out/summary.csv"), HasSubstr("\"in/far/away/fish.obj\",\"rigged\","));
}

TEST_F(BatchCommand, one_bad_file_stops_no_other) {
  std::ofstream(folder_ / "in/broken.obj") << "f 1 2 3\n";
  std::ofstream(folder_ / "in/notes.txt") << "not a character\n";
  const auto run = osteon(folder_, "batch in -o out");
  EXPECT_EQ(run.code, 2);
  EXPECT_THAT(run.out, HasSubstr("5 of 5 files: 4 rigged, 0 refused, 1 failed"));
  EXPECT_EQ(report("out/broken.json")["status"], "failed");
  EXPECT_THAT(report("out/broken.json")["why"], HasSubstr("broken.obj"));
  EXPECT_FALSE(fs::exists(folder_ / "out/broken.glb"));
  for (const char* rig : kRigs) EXPECT_TRUE(fs::exists(folder_ / "out" / rig)) << rig;
}

TEST_F(BatchCommand, links_that_lead_nowhere_stop_no_other) {
  fs::create_symlink("gone.obj", folder_ / "in/dangling.obj");
  fs::create_symlink("circle.obj", folder_ / "in/circle.obj");
  const auto run = osteon(folder_, "batch in -o out");
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, HasSubstr("4 of 4 files: 4 rigged"));
}

TEST_F(BatchCommand, does_again_only_what_changed) {
  ASSERT_EQ(osteon(folder_, "batch in -o out").code, 0);
  const auto written = fs::last_write_time(folder_ / "out/hero.glb");
  EXPECT_THAT(osteon(folder_, "batch in -o out").out, HasSubstr("4 of these before"));
  EXPECT_EQ(fs::last_write_time(folder_ / "out/hero.glb"), written);
  fs::remove(folder_ / "out/horse.glb");
  fs::last_write_time(folder_ / "in/hero.obj", fs::last_write_time(folder_ / "in/hero.obj") + std::chrono::seconds(1));
  EXPECT_THAT(osteon(folder_, "batch in -o out").out, HasSubstr("2 of these before"));
  EXPECT_THAT(osteon(folder_, "batch in -o out --detail 0.3").out, HasSubstr("0 of these before"));
  EXPECT_THAT(osteon(folder_, "batch in -o out --detail 0.3 --again").out, HasSubstr("0 of these before"));
}

TEST_F(BatchCommand, does_all_again_with_other_weights) {
  const char* folder = std::getenv("OSTEON_MODELS");
  fs::copy(folder ? fs::path(folder) / "rignet" : fs::path(OSTEON_MODELS_FOLDER "/rignet"), folder_ / "mine");
  ASSERT_EQ(osteon(folder_, "batch in -o out --models mine").code, 0);
  EXPECT_THAT(osteon(folder_, "batch in -o out --models mine").out, HasSubstr("4 of these before"));
  fs::last_write_time(folder_ / "mine/votes.safetensors", fs::file_time_type::clock::now() + std::chrono::hours(1));
  EXPECT_THAT(osteon(folder_, "batch in -o out --models mine").out, HasSubstr("0 of these before"));
}

// Killed at any moment, begun again: the same files as without, and nothing else.
TEST_F(BatchCommand, goes_on_after_it_was_killed) {
  ASSERT_EQ(osteon(folder_, "batch in -o whole").code, 0);
  for (const char* seconds : {"0.15", "0.3", "0.45"}) {
    const std::string kill =
        fmt::format("cd {} && timeout -s KILL {} {} batch in -o out >/dev/null 2>&1", folder_.path().string(), seconds, OSTEON_PROGRAM);
    [[maybe_unused]] const int killed = std::system(kill.c_str());
    for (const char* rig : kRigs)
      if (fs::exists(folder_ / "out" / rig)) EXPECT_TRUE(content(folder_ / "out" / rig) == content(folder_ / "whole" / rig)) << rig;
  }
  ASSERT_EQ(osteon(folder_, "batch in -o out").code, 0);
  std::size_t files = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder_ / "out")) files += entry.is_regular_file();
  EXPECT_EQ(files, 2 * kRigs.size() + 1);
  for (const char* rig : kRigs) EXPECT_TRUE(content(folder_ / "out" / rig) == content(folder_ / "whole" / rig)) << rig;
}

// Whoever takes all GLBs of the folder gets none that the last run refused, or could not make.
TEST_F(BatchCommand, leaves_no_earlier_rig_of_what_it_refuses_now) {
  fs::create_directories(folder_ / "out");
  ASSERT_EQ(osteon(folder_, "rig in/horse.obj -o out/horse.glb --preview out/horse.png --report out/horse.json").code, 0);
  fs::rename(folder_ / "in/horse.obj", folder_ / "horse.obj");  // so that these are not batch's own
  ASSERT_EQ(osteon(folder_, "batch in -o out --previews").code, 0);
  fs::rename(folder_ / "horse.obj", folder_ / "in/horse.obj");
  std::ofstream(folder_ / "in/far/bird.obj") << "f 1 2 3\n";
  EXPECT_EQ(osteon(folder_, "batch in -o out --min-confidence 1").code, 2);
  EXPECT_EQ(report("out/hero.json")["status"], "refused");
  EXPECT_EQ(report("out/far/bird.json")["status"], "failed");
  for (const char* gone : {"hero.glb", "hero.png", "far/bird.glb", "far/bird.png", "far/away/fish.glb", "far/away/fish.png"})
    EXPECT_FALSE(fs::exists(folder_ / "out" / gone)) << gone;
  for (const char* left : {"horse.glb", "horse.png"}) EXPECT_TRUE(fs::exists(folder_ / "out" / left)) << left;
}

TEST_F(BatchCommand, leaves_no_picture_of_an_earlier_rig) {
  ASSERT_EQ(osteon(folder_, "batch in -o out --previews").code, 0);
  ASSERT_EQ(osteon(folder_, "batch in -o out --detail 0.3").code, 0);
  EXPECT_TRUE(fs::exists(folder_ / "out/hero.glb"));
  EXPECT_FALSE(fs::exists(folder_ / "out/hero.png"));
}

TEST_F(BatchCommand, names_that_meet_keep_their_extensions) {
  io::save_obj(folder_ / "in/hero.OBJ", synth::make_character(synth::Kind::Biped, 4, {40, synth::Finish::Faceted}).mesh);
  ASSERT_EQ(osteon(folder_, "batch in -o out").code, 0);
  EXPECT_TRUE(fs::exists(folder_ / "out/hero.obj.glb"));
  EXPECT_TRUE(fs::exists(folder_ / "out/hero.OBJ.glb"));
}

// A folder of links to characters that lie elsewhere: the results stay in the folder that was asked for, the characters as they are.
TEST_F(BatchCommand, writes_nothing_outside_its_folder) {
  fs::create_directories(folder_ / "linked/far");
  fs::copy_file(folder_ / "in/hero.obj", folder_ / "elsewhere.obj");
  ASSERT_EQ(osteon(folder_, "rig in/hero.obj -o precious.glb").code, 0);
  const std::string before = content(folder_ / "precious.glb");
  fs::create_symlink(folder_ / "precious.glb", folder_ / "linked/precious.glb");
  fs::create_symlink("../../elsewhere.obj", folder_ / "linked/far/other.obj");
  for (const char* input : {"linked", "linked/", "./linked/../linked"}) {
    fs::remove_all(folder_ / "out");
    ASSERT_EQ(osteon(folder_, fmt::format("batch {} -o out", input)).code, 0);
    EXPECT_TRUE(fs::exists(folder_ / "out/precious.glb") && fs::exists(folder_ / "out/far/other.glb")) << input;
    EXPECT_TRUE(content(folder_ / "precious.glb") == before);
    EXPECT_FALSE(fs::exists(folder_ / "precious.json") || fs::exists(folder_ / "elsewhere.glb"));
  }
}

TEST_F(BatchCommand, removes_only_what_is_its_own) {
  fs::create_directories(folder_ / "out/other");
  for (const char* name : {"out/notes.1.tmp", "out/other/hero.glb.12.tmp", "out/hero.glb.12.tmp"}) std::ofstream(folder_ / name) << "half";
  ASSERT_EQ(osteon(folder_, "batch in -o out").code, 0);
  EXPECT_TRUE(fs::exists(folder_ / "out/notes.1.tmp"));
  EXPECT_TRUE(fs::exists(folder_ / "out/other/hero.glb.12.tmp"));
  EXPECT_FALSE(fs::exists(folder_ / "out/hero.glb.12.tmp"));
}

TEST_F(BatchCommand, never_overwrites_a_character) {
  ASSERT_EQ(osteon(folder_, "rig in/hero.obj -o in/rigged.glb").code, 0);
  const std::string before = content(folder_ / "in/rigged.glb");
  EXPECT_THAT(osteon(folder_, "batch in -o in").err, HasSubstr("the results would lie among the characters"));
  EXPECT_THAT(osteon(folder_, "batch in/ -o ./in/.").err, HasSubstr("the results would lie among the characters"));
  fs::create_directories(folder_ / "out");
  fs::create_symlink(folder_ / "in/rigged.glb", folder_ / "out/hero.glb");
  EXPECT_THAT(osteon(folder_, "batch in -o out").err, HasSubstr("would overwrite it"));
  EXPECT_TRUE(content(folder_ / "in/rigged.glb") == before);
}

TEST_F(BatchCommand, never_overwrites_its_skeleton_or_one_result_by_another) {
  ASSERT_EQ(osteon(folder_, "rig in/hero.obj -o hero.glb").code, 0);
  fs::create_directories(folder_ / "out");
  fs::rename(folder_ / "hero.glb", folder_ / "out/hero.glb");
  const std::string before = content(folder_ / "out/hero.glb");
  EXPECT_THAT(osteon(folder_, "batch in -o out --skeleton out/hero.glb").err, HasSubstr("would overwrite it"));
  EXPECT_TRUE(content(folder_ / "out/hero.glb") == before);
  for (const char* name : {"in/bird.stl", "in/bird.obj", "in/bird.obj.obj"}) fs::copy_file(folder_ / "in/far/bird.obj", folder_ / name);
  EXPECT_THAT(osteon(folder_, "batch in -o other").err, HasSubstr("bird.obj.glb: the result of in/bird.obj.obj would overwrite it"));
}

TEST_F(BatchCommand, says_what_is_wrong_with_a_folder) {
  EXPECT_THAT(osteon(folder_, "batch nowhere -o out").err, HasSubstr("nowhere: expected a folder"));
  fs::create_directories(folder_ / "empty");
  EXPECT_THAT(osteon(folder_, "batch empty -o out").err, HasSubstr("empty: found no characters"));
}

}  // namespace
}  // namespace osteon
