// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <vector>

#include "../outputs.h"
#include "osteon/base/error.h"
#include "osteon/io/load.h"
#include "osteon/io/texture_files.h"
#include "osteon/rig/rig.h"

namespace osteon::app {

// A character with its rig. Throws Error naming the file when it has no skeleton or no skin weights, or where one of the outputs would
// overwrite one of its textures.
inline Rig load_rig(const std::filesystem::path& path, const std::vector<Output>& outputs = {}) {
  io::Asset asset = io::load(path);
  check_outputs(io::texture_files(asset), outputs);
  if (!asset.skeleton || !asset.weights) throw Error("{}: has no skeleton with skin weights", path.string());
  return {std::move(asset.mesh), std::move(*asset.skeleton), std::move(*asset.weights)};
}

}  // namespace osteon::app
