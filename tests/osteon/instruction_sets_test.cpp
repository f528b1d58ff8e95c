// SPDX-License-Identifier: Apache-2.0
// Older processors: the same rig but for rounding. oneDNN takes the newest instructions that it finds; here it is told to look no further.
// (Our own loops, base/every_cpu.h, choose by themselves and cannot be told.)
#include <cstdlib>

#include "osteon/io/load.h"
#include "osteon/io/save.h"
#include "osteon/program.h"
#include "osteon/synth/character.h"

namespace osteon {
namespace {

using test::osteon;

class InstructionSets : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(OSTEON_MODELS_FOLDER "/rignet")) GTEST_SKIP() << "models/rignet is not there";
    io::save_obj(folder_ / "body.obj", synth::make_character(synth::Kind::Biped, 3, {48, synth::Finish::Smooth}).mesh);
  }
  void TearDown() override { ::unsetenv("ONEDNN_MAX_CPU_ISA"); }

  io::Asset rigged(const char* instructions) {
    if (instructions) ::setenv("ONEDNN_MAX_CPU_ISA", instructions, 1);
    const auto run = osteon(folder_, "rig body.obj -o out.glb --min-confidence 0");
    EXPECT_EQ(run.code, 0) << run.err;
    return io::load(folder_ / "out.glb");
  }

  test::TemporaryFolder folder_;
};

TEST_P(InstructionSets, give_the_same_rig_but_for_rounding) {
  const io::Asset newest = rigged(nullptr), older = rigged(GetParam());
  ASSERT_EQ(older.skeleton->names, newest.skeleton->names);
  EXPECT_EQ(older.skeleton->parents, newest.skeleton->parents);
  for (JointId j : newest.skeleton->names.ids())
    EXPECT_VEC3_NEAR(older.skeleton->rest_positions[j], newest.skeleton->rest_positions[j], 1e-3f) << newest.skeleton->names[j];
  double difference = 0.0;
  for (VertexId v : newest.mesh.positions.ids()) {
    std::vector<float> row(newest.skeleton->size(), 0.0f);
    for (const Influence& i : (*newest.weights)[v]) row[index(i.joint)] += i.weight;
    for (const Influence& i : (*older.weights)[v]) row[index(i.joint)] -= i.weight;
    for (const float d : row) difference += static_cast<double>(std::abs(d));
  }
  EXPECT_LT(difference / static_cast<double>(newest.mesh.positions.size()), 1e-3);
}

INSTANTIATE_TEST_SUITE_P(Older, InstructionSets, testing::Values("AVX2", "SSE41"),
                         [](const auto& test_case) { return std::string(test_case.param); });

}  // namespace
}  // namespace osteon
