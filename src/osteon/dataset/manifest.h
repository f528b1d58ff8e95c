// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "osteon/dataset/prepared.h"

namespace osteon::dataset {

// One line of a data folder's manifest.jsonl.
struct ManifestEntry {
  CharacterInfo info;          // category: the part before a slash ("robot" of "robot/mech")
  std::filesystem::path file;  // the GLB, with the folder's path in front
  std::string split;           // "train", "val" or "test"
  std::string licence, author, source;
};

// The entries of `split` (of all splits where it is empty), in the file's order. Throws Error naming the line that is not as expected
// or has the id of an earlier one, or the split that has no characters.
std::vector<ManifestEntry> read_manifest(const std::filesystem::path& folder, const std::string& split);

// Where characters come from, for the weights that learn from them: a JSON list of {licence, author, source, characters (how many)}, by
// source and author.
std::string sources_of(const std::vector<ManifestEntry>& entries);

}  // namespace osteon::dataset
