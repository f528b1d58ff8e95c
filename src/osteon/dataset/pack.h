// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "osteon/dataset/prepared.h"

namespace osteon::dataset {

// Writes characters into one safetensors file: the working mesh, the targets and the nearest bones, compactly (about 80 kB each at 1200
// vertices); `metadata` is added to the file's. What follows from the mesh is left out. Throws Error when it cannot be written.
void save_characters(const std::filesystem::path& path, std::span<const PreparedCharacter> characters,
                     const std::map<std::string, std::string>& metadata = {});

// Reads such a file, in parallel, and computes the left out parts again. Throws Error naming the file and the character.
std::vector<PreparedCharacter> load_characters(const std::filesystem::path& path);

}  // namespace osteon::dataset
