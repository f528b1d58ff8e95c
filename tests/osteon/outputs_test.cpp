// SPDX-License-Identifier: Apache-2.0
// What the commands write costs nobody a file.
#include "osteon/io/save.h"
#include "osteon/mesh/shapes.h"
#include "osteon/program.h"

namespace osteon {
namespace {

using test::osteon;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;
namespace fs = std::filesystem;

class Outputs : public testing::Test {
 protected:
  void SetUp() override {
    io::save_obj(folder_ / "ball.obj", shapes::icosphere(2));
    ASSERT_EQ(osteon(folder_, "synth biped --seed 3 --cells 32 -o hero.glb").code, 0);
    fs::copy_file(folder_ / "hero.glb", folder_ / "other.glb");
    std::ofstream(folder_ / "words.txt") << "words";
    std::ofstream(folder_ / "ball.png") << "picture";
  }

  // The command ends with 2 and one line that says `why`, and all files are as before.
  void expect_refused(const std::string& arguments, const std::string& why) {
    const auto before = files_of(folder_);
    const auto run = osteon(folder_, arguments);
    EXPECT_EQ(run.code, 2) << arguments;
    EXPECT_THAT(run.err, AllOf(StartsWith("error: "), HasSubstr(why))) << arguments;
    EXPECT_EQ(std::ranges::count(run.err, '\n'), 1) << arguments;
    EXPECT_TRUE(files_of(folder_) == before) << arguments;
  }

  test::TemporaryFolder folder_;
};

TEST_F(Outputs, have_the_names_of_their_kind) {
  for (const char* name : {"x.fbx", "x.obj", "x.gltf", "x", "-", "ball.obj"}) {
    expect_refused(fmt::format("rig ball.obj -o {}", name), fmt::format("-o {}: expected a name that ends in .glb", name));
    expect_refused(fmt::format("skin hero.glb -o {}", name), "ends in .glb");
  }
  for (const char* option : {"--preview x.jpg", "--report x.glb", "--report ball.obj", "--rigtxt x.obj"})
    expect_refused(fmt::format("rig ball.obj -o x.glb {}", option), std::string(option) + ": expected a name that ends in");
  expect_refused("skin hero.glb -o x.glb --preview x.glb", "--preview x.glb: expected a name that ends in .png");
  expect_refused("skin hero.glb -o x.glb --report x.txt", "--report x.txt: expected a name that ends in .json");
  expect_refused("render ball.obj -o x.jpg", "-o x.jpg: expected a name that ends in .png");
  expect_refused("synth biped -o x.obj", "-o x.obj: expected a name that ends in .glb");
  expect_refused("synth biped -o x.glb --bare", "-o x.glb: expected a name that ends in .obj");
  expect_refused("synth biped -o x.glb --sheet 1", "-o x.glb: expected a name that ends in .png");
  expect_refused("compare hero.glb other.glb --json hero.glb", "--json hero.glb: expected a name that ends in .json");
  expect_refused("compare hero.glb other.glb --picture x.svg", "--picture x.svg: expected a name that ends in .png");
  expect_refused("evaluate hero.glb other.glb --json other.glb", "--json other.glb: expected a name that ends in .json");
  expect_refused("dataset prepare --data . -o hero.glb", "-o hero.glb: expected a name that ends in .safetensors");
}

TEST_F(Outputs, may_end_in_capitals) { EXPECT_EQ(osteon(folder_, "synth biped --cells 32 -o LOUD.GLB").code, 0); }

TEST_F(Outputs, never_overwrite_an_input_under_whatever_name) {
  fs::create_symlink("hero.glb", folder_ / "link.glb");
  for (const char* name : {"hero.glb", "./hero.glb", "link.glb"}) {
    expect_refused(fmt::format("rig hero.glb -o {}", name), "hero.glb would be overwritten");
    expect_refused(fmt::format("skin hero.glb -o {}", name), "hero.glb would be overwritten");
    expect_refused(fmt::format("rig ball.obj --skeleton hero.glb -o {}", name), "hero.glb would be overwritten");
    expect_refused(fmt::format("skin ball.obj --skeleton hero.glb -o {}", name), "hero.glb would be overwritten");
    expect_refused(fmt::format("skin other.glb --method transfer --from hero.glb -o {}", name), "hero.glb would be overwritten");
  }
}

TEST_F(Outputs, of_rig_txt_overwrite_the_mesh_of_an_earlier_one_alone) {
  expect_refused("rig hero.glb -o x.glb --rigtxt ball.txt", "ball.obj would be overwritten");
  expect_refused("rig words.txt -o x.glb --rigtxt words.txt", "words.txt would be overwritten");
}

TEST_F(Outputs, never_overwrite_a_texture) {
  const std::string mesh = test::content(folder_ / "ball.obj");
  std::ofstream(folder_ / "ball.mtl") << "newmtl skin\nmap_Kd ball.png\n";
  std::ofstream(folder_ / "ball.obj") << "mtllib ball.mtl\nvt 0 0\nusemtl skin\nf 1/1 2/1 3/1\n" << mesh;
  expect_refused("render ball.obj -o ball.png", "ball.png would be overwritten");
  expect_refused("skin ball.obj --skeleton hero.glb -o x.glb --preview ball.png", "ball.png would be overwritten");
}

TEST_F(Outputs, need_a_folder_that_is_there) {
  expect_refused("rig ball.obj -o missing/x.glb --report x.json", "-o missing/x.glb: there is no folder missing");
  expect_refused("render ball.obj -o words.txt/x.png", "there is no folder words.txt");
}

}  // namespace
}  // namespace osteon
