// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "osteon/base/error.h"
#include "osteon/io/load.h"
#include "osteon/rig/rig.h"

namespace osteon::app {

// A character with its rig. Throws Error naming the file when it has no skeleton or no skin weights.
inline Rig load_rig(const std::filesystem::path& path) {
  io::Asset asset = io::load(path);
  if (!asset.skeleton || !asset.weights) throw Error("{}: has no skeleton with skin weights", path.string());
  return {std::move(asset.mesh), std::move(*asset.skeleton), std::move(*asset.weights)};
}

}  // namespace osteon::app
