// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

#include "choice.h"
#include "osteon/io/load.h"

namespace osteon::app {

// --up and --scale, for every command that reads a character.
inline void add_load_options(CLI::App& command, io::LoadOptions& options) {
  add_choice(command, "--up", options.up, {{"auto", std::nullopt}, {"x", io::UpAxis::x}, {"y", io::UpAxis::y}, {"z", io::UpAxis::z}},
             "Axis of the file that points up (auto: what the file says, or else y; rig and skin also look whether it is z)");
  command
      .add_option_function<float>(
          "--scale", [&options](const float& scale) { options.scale = scale; }, "Metres in one unit of the file")
      ->check(CLI::PositiveNumber);
}

}  // namespace osteon::app
