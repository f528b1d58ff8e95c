// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "osteon/pipelines/rig_report.h"

namespace osteon::app {

// How a rig came about and what writing it changed in the asset, for other programs. Keys are those of pipelines::RigReport, and "changes";
// what does not apply is null.
nlohmann::ordered_json to_json(const pipelines::RigReport& report, const std::vector<std::string>& changes);

// Any JSON as a file, indented; nobody ever sees half of it. Names that are not UTF-8 are mended.
void save_json(const std::filesystem::path& path, const nlohmann::ordered_json& json);

}  // namespace osteon::app
