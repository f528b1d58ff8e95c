// SPDX-License-Identifier: Apache-2.0
#include "osteon/infer/model_folder.h"

#include "support/expect.h"

namespace osteon::infer {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

TEST(ModelFolder, the_environment_comes_first_and_alone) {
  const test::TemporaryFolder folder;
  fs::create_directories(folder / "bin/models/rignet");
  fs::create_directories(folder / "mine/rignet");
  EXPECT_EQ(find_models("rignet", folder / "mine", folder / "bin"), folder / "mine/rignet");
  EXPECT_THAT(test::error_of([&] { find_models("rignet", folder / "other", folder / "bin"); }), HasSubstr("OSTEON_MODELS"));
}

TEST(ModelFolder, installed_then_beside_the_program_then_above_it) {
  const test::TemporaryFolder folder;
  const fs::path bin = folder / "tree/build/release/bin";
  fs::create_directories(folder / "tree/models/rignet");
  EXPECT_EQ(find_models("rignet", {}, bin), folder / "tree/models/rignet");
  fs::create_directories(bin / "models/rignet");
  EXPECT_EQ(find_models("rignet", {}, bin), bin / "models/rignet");
  fs::create_directories(folder / "tree/build/release/share/osteon/models/rignet");
  EXPECT_EQ(find_models("rignet", {}, bin), folder / "tree/build/release/share/osteon/models/rignet");
}

TEST(ModelFolder, the_error_lists_every_place) {
  const std::string error = test::error_of([] { find_models("rignet", {}, "/nowhere/build/release/bin"); });
  for (const char* place : {"/nowhere/build/release/share/osteon/models/rignet", "/nowhere/build/release/bin/models/rignet",
                            "/nowhere/build/release/models/rignet", "/nowhere/build/models/rignet", "/nowhere/models/rignet"})
    EXPECT_THAT(error, HasSubstr(place));
}

}  // namespace
}  // namespace osteon::infer
