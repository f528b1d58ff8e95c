// SPDX-License-Identifier: Apache-2.0
#include "osteon/program.h"

#include "osteon/io/save.h"
#include "osteon/mesh/shapes.h"

namespace osteon {
namespace {

using test::osteon;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::StartsWith;

TEST(Program, says_its_version) {
  const test::TemporaryFolder folder;
  const auto run = osteon(folder, "--version");
  EXPECT_EQ(run.code, 0);
  EXPECT_THAT(run.out, StartsWith("osteon "));
}

TEST(Program, what_could_not_be_printed_is_an_error) {
  const test::TemporaryFolder folder;
  const auto run = test::run_in(folder, "(" OSTEON_PROGRAM " --version >/dev/full)");
  EXPECT_EQ(run.code, 2);
  EXPECT_EQ(run.err, "error: cannot write to the standard output\n");
}

TEST(Program, wrong_options_end_with_2_and_one_line) {
  const test::TemporaryFolder folder;
  for (const char* arguments : {"", "dance", "rig", "render a.obj", "render a.obj -o a.png --size 0 0", "rig a.obj -o a.glb --detail 7",
                                "rig a.obj -o a.glb --joints 5 --detail 1", "--threads 0 rig a.obj -o a.glb"}) {
    const auto run = osteon(folder, arguments);
    EXPECT_EQ(run.code, 2) << arguments;
    EXPECT_THAT(run.err, StartsWith("error: ")) << arguments;
    EXPECT_EQ(std::ranges::count(run.err, '\n'), 1) << arguments;
  }
}

TEST(Program, an_unknown_command_is_named_and_so_are_those_there_are) {
  const test::TemporaryFolder folder;
  const auto says = [&](const char* arguments) { return osteon(folder, arguments).err; };
  EXPECT_THAT(says("foo a.obj -o a.glb"), StartsWith("error: foo: expected a command: rig, batch, skin, "));
  EXPECT_THAT(says(""), StartsWith("error: expected a command: rig, "));
  EXPECT_THAT(says("dataset foo"), StartsWith("error: foo: expected a command: prepare"));
  EXPECT_THAT(says("rig a.obj"), HasSubstr("--output is required"));
}

TEST(Program, choices_are_made_by_name_alone) {
  const test::TemporaryFolder folder;
  for (const char* option : {"--fingers", "--symmetry"})
    for (const char* value : {"0", "1", "on"})
      EXPECT_THAT(osteon(folder, fmt::format("rig a.obj -o a.glb {} {}", option, value)).err,
                  HasSubstr(fmt::format("{}: {} not in {{auto,off}}", option, value)));
  EXPECT_THAT(osteon(folder, "rig a.obj -o a.glb --precision 1").err, HasSubstr("1 not in {bf16,f32}"));
  EXPECT_THAT(osteon(folder, "rig a.obj -o a.glb --up 1").err, HasSubstr("1 not in {auto,x,y,z}"));
  EXPECT_THAT(osteon(folder, "evaluate a.glb b.glb --up 1").err, HasSubstr("1 not in {x,y,z}"));
  EXPECT_THAT(osteon(folder, "rig --help").out, HasSubstr("--fingers auto|off=auto"));
}

TEST(Program, evaluation_of_nothing_is_an_error) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "manifest.jsonl")
      << R"({"id":"a","file":"a.glb","split":"val","group":"g","category":"c","licence":"l","author":"a","source_repo":"s"})";
  const auto run = osteon(folder, "evaluate --data .");
  EXPECT_EQ(run.code, 2);
  EXPECT_THAT(run.out, HasSubstr("a.glb: no such file"));
  EXPECT_THAT(run.err, HasSubstr("nothing could be measured"));
  EXPECT_THAT(osteon(folder, "evaluate --data . --json a.json --gallery a.png").err, HasSubstr("--json excludes --gallery"));
  EXPECT_THAT(osteon(folder, "evaluate --data . --scale nan").err, HasSubstr("--scale: found nan"));
}

TEST(Program, bad_files_end_with_2_and_are_named) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "empty.obj");
  std::ofstream(folder / "garbage.glb") << "glTF but not really";
  for (const char* name : {"missing.obj", "empty.obj", "garbage.glb"}) {
    const auto run = osteon(folder, fmt::format("render {} -o a.png", name));
    EXPECT_EQ(run.code, 2) << name;
    EXPECT_THAT(run.err, AllOf(StartsWith("error: "), HasSubstr(name)));
    EXPECT_FALSE(std::filesystem::exists(folder / "a.png"));
  }
}

TEST(Program, a_character_without_extent_is_named_where_it_is_measured) {
  const test::TemporaryFolder folder;
  io::Asset asset;
  asset.mesh = shapes::icosphere(0);
  for (Vec3f& p : asset.mesh.positions) p = Vec3f(1, 2, 3);
  Skeleton skeleton;
  skeleton.add("root", std::nullopt, Vec3f(1, 2, 3));
  SkinWeights weights;
  const Influence whole{JointId{0}, 1.0f};
  for (std::size_t v = 0; v < asset.mesh.positions.size(); ++v) weights.append({&whole, 1});
  io::save_glb(folder / "point.glb", asset, skeleton, weights);
  for (const char* command : {"compare", "evaluate"}) {
    const auto run = osteon(folder, fmt::format("{} point.glb point.glb", command));
    EXPECT_EQ(run.code, 2) << command;
    EXPECT_THAT(run.err, StartsWith("error: point.glb: the mesh is 0 in size")) << command;
  }
}

TEST(Program, draws_a_mesh_without_a_rig) {
  const test::TemporaryFolder folder;
  io::save_obj(folder / "ball.obj", shapes::icosphere(2));
  const auto run = osteon(folder, "render ball.obj -o ball.png --size 200 100");
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(test::content(folder / "ball.png"), StartsWith("\x89PNG"));
  EXPECT_EQ(osteon(folder, "render ball.obj -o same.png --size 200,100").code, 0);
  EXPECT_TRUE(test::content(folder / "same.png") == test::content(folder / "ball.png"));
}

TEST(Program, draws_the_same_bytes_with_one_and_two_threads) {
  const test::TemporaryFolder folder;
  ASSERT_EQ(osteon(folder, "synth biped --seed 5 --cells 64 -o a.glb").code, 0);
  ASSERT_EQ(osteon(folder, "render a.glb -o one.png --size 300 150 --threads 1").code, 0);
  ASSERT_EQ(osteon(folder, "--threads 2 render a.glb -o two.png --size 300 150").code, 0);
  ASSERT_EQ(osteon(folder, "render a.glb -o rest.png --size 300 150 --pose none").code, 0);
  EXPECT_TRUE(test::content(folder / "one.png") == test::content(folder / "two.png"));
  EXPECT_FALSE(test::content(folder / "one.png") == test::content(folder / "rest.png"));
}

TEST(Program, an_unknown_pose_is_refused) {
  const test::TemporaryFolder folder;
  io::save_obj(folder / "ball.obj", shapes::icosphere(1));
  const auto run = osteon(folder, "render ball.obj -o ball.png --pose dance");
  EXPECT_EQ(run.code, 2);
  EXPECT_THAT(run.err, HasSubstr("--pose: found 'dance', expected a number or 'none'"));
}

}  // namespace
}  // namespace osteon
