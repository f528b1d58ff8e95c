// SPDX-License-Identifier: Apache-2.0
#include "osteon/dataset/manifest.h"

#include <fstream>

#include "support/expect.h"

namespace osteon::dataset {
namespace {

std::string line(const std::string& id, const std::string& split) {
  return fmt::format(
      R"({{"id": "{0}", "file": "characters/{0}.glb", "category": "robot/mech", "group": "g1", "split": "{1}", "licence": "CC0-1.0", "author": "A", "source_repo": "S"}})"
      "\n",
      id, split);
}

void write(const std::filesystem::path& path, const std::string& text) { std::ofstream(path) << text; }

TEST(Manifest, gives_the_characters_of_a_split_in_order) {
  const test::TemporaryFolder folder;
  write(folder / "manifest.jsonl", line("a", "train") + line("b", "val") + "\n" + line("c", "train"));
  const auto entries = read_manifest(folder.path(), "train");
  ASSERT_EQ(entries.size(), 2u);
  EXPECT_EQ(entries[0].info.id, "a");
  EXPECT_EQ(entries[1].info.id, "c");
  EXPECT_EQ(entries[1].info.category, "robot");
  EXPECT_EQ(entries[1].file, folder.path() / "characters/c.glb");
  EXPECT_EQ(read_manifest(folder.path(), "").size(), 3u);
}

TEST(Manifest, counts_the_characters_of_each_source) {
  const ManifestEntry a{{}, {}, "train", "CC0-1.0", "Anna", "https://a"}, b{{}, {}, "train", "MIT", "Ben", "https://b"};
  EXPECT_EQ(sources_of({a, b, a}), R"([{"author":"Anna","characters":2,"licence":"CC0-1.0","source":"https://a"},)"
                                   R"({"author":"Ben","characters":1,"licence":"MIT","source":"https://b"}])");
}

TEST(Manifest, names_the_line_that_is_broken) {
  const test::TemporaryFolder folder;
  const auto error_with = [&](const std::string& second) {
    write(folder / "manifest.jsonl", line("a", "train") + second);
    return test::error_of([&] { read_manifest(folder.path(), "train"); });
  };
  EXPECT_THAT(error_with("nonsense\n"), testing::HasSubstr("manifest.jsonl: line 2: "));
  EXPECT_THAT(error_with("{\"category\": 3}\n"), testing::HasSubstr("manifest.jsonl: line 2: \"category\": found 3, expected a text"));
  EXPECT_THAT(error_with("{\"id\": \"b\"}\n"), testing::HasSubstr("manifest.jsonl: line 2: has no \"category\""));
  EXPECT_THAT(error_with("[]\n"), testing::HasSubstr("manifest.jsonl: line 2: has no \"category\""));
  EXPECT_THAT(error_with(line("a", "val")), testing::HasSubstr("manifest.jsonl: line 2: the id 'a' is that of line 1 too"));
}

TEST(Manifest, may_have_blank_lines_and_those_of_windows) {
  const test::TemporaryFolder folder;
  std::string text = line("a", "train");
  text.insert(text.size() - 1, "\r");
  write(folder / "manifest.jsonl", text + "\r\n  \n");
  EXPECT_EQ(read_manifest(folder.path(), "train").size(), 1u);
}

TEST(Manifest, names_the_split_that_is_not_there) {
  const test::TemporaryFolder folder;
  write(folder / "manifest.jsonl", line("a", "train"));
  EXPECT_THAT(test::error_of([&] { read_manifest(folder.path(), "trian"); }), testing::HasSubstr("no character has the split 'trian'"));
}

TEST(Manifest, names_a_folder_without_one) {
  EXPECT_THAT(test::error_of([] { read_manifest("/nowhere", "train"); }), testing::StartsWith("/nowhere/manifest.jsonl: cannot be opened"));
}

}  // namespace
}  // namespace osteon::dataset
