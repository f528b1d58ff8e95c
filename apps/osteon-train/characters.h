// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "osteon/dataset/manifest.h"

namespace osteon::app {

// The rigged characters of a folder, made ready to learn from.
struct Characters {
  std::vector<dataset::PreparedCharacter> train;
  std::vector<dataset::PreparedCharacter> validation;  // those that a manifest names; else empty
  std::string sources;                                 // dataset::sources_of them
  std::vector<std::string> left_out;                   // the file and why
};

// With manifest.jsonl: the characters of its splits train and val (test is left alone). Without: every .glb and .gltf below the folder, by
// path. `progress` is called with the share done, from any thread. Throws Error where the folder has no such files, or fewer than two that
// can be used (naming the others and why).
Characters read_characters(const std::filesystem::path& folder, const std::function<void(double)>& progress);

}  // namespace osteon::app
