// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

#include "osteon/io/load.h"

namespace osteon::app {

// --up and --scale, for every command that reads a character.
inline void add_load_options(CLI::App& command, io::LoadOptions& options) {
  static const std::map<std::string, io::UpAxis> axes{{"x", io::UpAxis::x}, {"y", io::UpAxis::y}, {"z", io::UpAxis::z}};
  command
      .add_option_function<io::UpAxis>(
          "--up", [&options](const io::UpAxis& up) { options.up = up; }, "Axis of the file that points up")
      ->transform(CLI::CheckedTransformer(axes))
      ->type_name("x|y|z");
  command
      .add_option_function<float>(
          "--scale", [&options](const float& scale) { options.scale = scale; }, "Metres in one unit of the file")
      ->check(CLI::PositiveNumber);
}

}  // namespace osteon::app
