// SPDX-License-Identifier: Apache-2.0
// The data that the shipped weights learned from and are judged by: nothing that is learned may come back as a question.
#include <gtest/gtest.h>

#include <map>

#include "osteon/base/parallel.h"
#include "osteon/dataset/manifest.h"
#include "osteon/dataset/solid_overlap.h"
#include "osteon/io/load.h"

namespace osteon {
namespace {

class Splits : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(OSTEON_DATA_FOLDER "/manifest.jsonl")) GTEST_SKIP() << "no characters in " OSTEON_DATA_FOLDER;
    entries_ = dataset::read_manifest(OSTEON_DATA_FOLDER, "");
  }
  std::vector<dataset::ManifestEntry> entries_;
};

TEST_F(Splits, keep_every_group_on_one_side) {
  std::map<std::string, std::string> split_of;
  for (const auto& entry : entries_) EXPECT_EQ(split_of.emplace(entry.info.group, entry.split).first->second, entry.split) << entry.info.group;
}

TEST_F(Splits, have_no_near_duplicates_of_training_characters_in_val_and_test) {
  std::vector<dataset::Solid> solids(entries_.size());
  parallel_for(entries_.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) solids[i] = dataset::solid_of(io::load(entries_[i].file).mesh);
  });
  for (std::size_t i = 0; i < entries_.size(); ++i)
    for (std::size_t j = 0; j < entries_.size(); ++j)
      if (entries_[i].split == "train" && entries_[j].split != "train")
        EXPECT_LE(dataset::overlap(solids[i], solids[j]), 0.95) << entries_[i].info.id << " and " << entries_[j].info.id;
}

}  // namespace
}  // namespace osteon
