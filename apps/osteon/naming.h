// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "osteon/base/error.h"

namespace osteon::app {

// Runs work that knows of no file; its Errors name the one that they are about.
template <class Work>
auto naming(const std::filesystem::path& file, const Work& work) {
  try {
    return work();
  } catch (const Error& e) {
    throw Error("{}: {}", file.string(), e.what());
  }
}

}  // namespace osteon::app
