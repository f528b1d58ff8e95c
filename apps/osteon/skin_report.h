// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "osteon/pipelines/skin_quality.h"

namespace osteon::app {

// The measures of skin weights without a reference, as JSON for other programs; what does not apply is null.
nlohmann::ordered_json to_json(const pipelines::SkinQuality& quality, const Skeleton& skeleton);

// Writes JSON to a file. Throws Error naming it when it cannot be written.
void write_json(const std::filesystem::path& path, const nlohmann::ordered_json& json);

}  // namespace osteon::app
