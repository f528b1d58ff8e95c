// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "osteon/io/load.h"

namespace osteon::io {

// The pictures that the asset's file names and that are there: a part of the asset, though not in its file.
std::vector<std::filesystem::path> texture_files(const Asset& asset);

}  // namespace osteon::io
