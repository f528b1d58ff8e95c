// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "osteon/dataset/prepared.h"

namespace osteon::dataset {

// Writes characters into one safetensors file, compactly (about 33 kB each at 1200 vertices): the working mesh, its positions rounded to
// 1/65535 of its longest side, the reference weights (to 1/65535), the skeleton, its tolerances, the attention and, where there are some,
// poses in half precision (24 bytes a joint and pose). What follows from these is left out. `metadata` is added to the file's. Throws Error
// when it cannot be written.
void save_characters(const std::filesystem::path& path, std::span<const PreparedCharacter> characters,
                     const std::map<std::string, std::string>& metadata = {});

// Reads such a file, in parallel, and computes the left out parts again, but for the nearest bones: see PreparedCharacter. Also the files
// of before, whose positions are floats and which hold the nearest bones. Throws Error naming the file and the character.
std::vector<PreparedCharacter> load_characters(const std::filesystem::path& path);

}  // namespace osteon::dataset
