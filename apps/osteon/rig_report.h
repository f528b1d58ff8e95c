// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>

#include "osteon/pipelines/rig_report.h"

namespace osteon::app {

// How a rig came about, as JSON for other programs. Keys are those of pipelines::RigReport; what does not apply is null.
void save_report(const std::filesystem::path& path, const pipelines::RigReport& report, const std::filesystem::path& input);

}  // namespace osteon::app
