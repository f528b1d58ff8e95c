// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <map>
#include <optional>
#include <string>

#include "osteon/io/load.h"

namespace osteon::app {

inline const std::map<std::string, io::UpAxis>& up_axes() {
  static const std::map<std::string, io::UpAxis> axes{{"x", io::UpAxis::x}, {"y", io::UpAxis::y}, {"z", io::UpAxis::z}};
  return axes;
}

// --up and --scale, for every command that reads a character.
inline void add_load_options(CLI::App& command, io::LoadOptions& options) {
  command
      .add_option_function<std::string>(
          "--up", [&options](const std::string& up) { options.up = up == "auto" ? std::nullopt : std::optional(up_axes().at(up)); },
          "Axis of the file that points up (auto: what the file says, or else y; rig also looks whether it is z)")
      ->check(CLI::IsMember({"auto", "x", "y", "z"}))
      ->type_name("auto|x|y|z");
  command
      .add_option_function<float>(
          "--scale", [&options](const float& scale) { options.scale = scale; }, "Metres in one unit of the file")
      ->check(CLI::PositiveNumber);
}

}  // namespace osteon::app
