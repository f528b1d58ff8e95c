// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "osteon/infer/rignet.h"
#include "osteon/metrics/score_table.h"

namespace osteon::app {

// Every method's skin for the reference's skeleton, on the characters of a split. The "category" of a row is the method.
// Columns: precision, recall, L1, mean and max distance. Throws Error where the models have no NeuroSkinning.
metrics::ScoreTable skin_methods_table(const std::filesystem::path& data, const std::string& split, const infer::RignetModels& models,
                                       const std::vector<metrics::ScoreColumn>& columns);

}  // namespace osteon::app
