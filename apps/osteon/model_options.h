// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>

#include "choice.h"
#include "osteon/infer/model_folder.h"
#include "osteon/infer/neuroskinning.h"
#include "osteon/infer/rignet.h"
#ifdef OSTEON_TORCH
#include "osteon/torch_infer/torch_runner.h"
#endif

namespace osteon::app {

// Which trained networks a command uses.
struct ModelOptions {
  std::string name = "rignet";
  std::optional<std::filesystem::path> folder;
  tensor::Precision precision = tensor::Precision::f32;
  std::string device;  // empty: oneDNN on the CPU

  void add_to(CLI::App& command) {
    CLI::Option* by_name = command.add_option("--model", name, "Which of the shipped networks: rignet (ours) or rignet-2020 (the paper's)")
                               ->capture_default_str();
    command.add_option("--models", folder, "Use the networks' weights of this folder")->type_name("FOLDER")->excludes(by_name);
    add_choice(command, "--precision", precision, {{"f32", tensor::Precision::f32}, {"bf16", tensor::Precision::bf16}},
               "Numbers that the networks multiply: f32, or bf16 on processors that have it, which is faster");
#ifdef OSTEON_TORCH
    command.add_option("--device", device,
                       "Run the networks on LibTorch, on this device: cpu, cuda or cuda:N (default: oneDNN on the CPU)");
#endif
  }
  std::filesystem::path weights() const { return folder ? *folder : infer::find_models(name); }
  infer::RignetModels load() const {
#ifdef OSTEON_TORCH
    if (!device.empty()) return infer::RignetModels::load(weights(), torch_infer::torch_runners(device));
#endif
    return infer::RignetModels::load(weights(), precision);
  }
  infer::NeuroskinningModel load_neuroskinning() const { return infer::NeuroskinningModel::load(weights(), precision); }
};

}  // namespace osteon::app
