// SPDX-License-Identifier: Apache-2.0
// Facts about the shared collection of rigged characters; skipped where it is absent.
#include <fstream>
#include <nlohmann/json.hpp>

#include "osteon/io/load.h"
#include "support/expect.h"

namespace osteon::io {
namespace {

const std::filesystem::path kData = std::filesystem::path(OSTEON_SOURCE_DIR) / ".." / "shared" / "data";

TEST(Corpus, every_training_character_loads_with_the_counts_of_the_manifest) {
  std::ifstream manifest(kData / "manifest.jsonl");
  if (!manifest) GTEST_SKIP() << kData << " is absent";
  for (std::string line; std::getline(manifest, line);) {
    const auto entry = nlohmann::json::parse(line);
    if (entry["split"] != "train") continue;
    SCOPED_TRACE(entry["file"].get<std::string>());
    const Asset asset = load(kData / entry["file"].get<std::string>());
    EXPECT_EQ(asset.mesh.positions.size(), entry["vertices"].get<std::size_t>());
    EXPECT_EQ(asset.mesh.faces.size(), entry["triangles"].get<std::size_t>());
    ASSERT_TRUE(asset.skeleton && asset.weights);
    EXPECT_EQ(asset.skeleton->size(), entry["joints"].get<std::size_t>());
    EXPECT_THAT(asset.repairs, testing::IsEmpty());
  }
}

}  // namespace
}  // namespace osteon::io
