// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>

#include "osteon/pipelines/rig_report.h"

namespace osteon::app {

// How a rig came about, for other programs. Keys are those of pipelines::RigReport; what does not apply is null.
nlohmann::ordered_json to_json(const pipelines::RigReport& report);

// The same as a file, after what it is about. Throws Error if it cannot be written.
void save_report(const std::filesystem::path& path, const pipelines::RigReport& report, const std::filesystem::path& input);

// Any JSON as a file, indented; nobody ever sees half of it. Names that are not UTF-8 are mended.
void save_json(const std::filesystem::path& path, const nlohmann::ordered_json& json);

}  // namespace osteon::app
