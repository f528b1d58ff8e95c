// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "../outputs.h"
#include "model_options.h"
#include "osteon/io/load.h"
#include "osteon/io/save.h"
#include "osteon/pipelines/confidence_fit.h"
#include "osteon/pipelines/rignet.h"

namespace osteon::app {

// How files are rigged: what `rig` and `batch` have in common.
struct RigOptions {
  ModelOptions models;
  std::optional<std::filesystem::path> skeleton;
  float min_confidence = pipelines::kLowConfidence;
  io::LoadOptions load;
  io::SaveOptions save;
  pipelines::RignetOptions rignet;

  void add_to(CLI::App& command);
};

struct RigOutputs {
  std::filesystem::path glb;
  std::optional<std::filesystem::path> preview, rigtxt;

  // Throws Error if one of them, or `report`, would cost the user a file (outputs.h).
  void check(const std::filesystem::path& input, const RigOptions& options, const std::optional<std::filesystem::path>& report) const;
};

// How a rig came about, with what was mended in the file that was read, and what writing it changed in the asset.
using Look = std::function<void(const pipelines::RigReport&, const std::vector<std::string>& changes)>;

// Reads a mesh, rigs it and writes the rig. What the user should know of it goes to `warn`, file names included. `look` comes last: when
// all is written, or nothing is as the rig is not good enough. Throws Error where a file cannot be read or written, and Refused where the
// confidence is below options.min_confidence.
void rig_file(const std::filesystem::path& input, const RigOutputs& outputs, const RigOptions& options, const infer::RignetModels& models,
              const std::function<void(const std::string&)>& warn, const Look& look);

}  // namespace osteon::app
