// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>

#include "osteon/infer/model_folder.h"
#include "osteon/infer/rignet.h"

namespace osteon::app {

// Which trained networks a command uses.
struct ModelOptions {
  std::string name = "rignet";
  std::optional<std::filesystem::path> folder;

  void add_to(CLI::App& command) {
    CLI::Option* by_name =
        command.add_option("--model", name, "Which of the shipped networks: rignet (ours) or rignet-2020 (the paper's)")->capture_default_str();
    command.add_option("--models", folder, "Use the networks' weights of this folder")->type_name("FOLDER")->excludes(by_name);
  }
  infer::RignetModels load() const { return infer::RignetModels::load(folder ? *folder : infer::find_models(name)); }
};

}  // namespace osteon::app
