// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "osteon/infer/rignet.h"
#include "osteon/pipelines/rignet.h"

namespace osteon::app {

// How far the confidence in joints and rigs is true, on the characters of a split and on things that are no characters, and how it
// would be truest. Writes into `folder`:
//   calibration.json   the measures, as shipped and fitted anew
//   confidence.svg     how often joints of each confidence are right
//   confidence_fit.h   for src/osteon/pipelines: what the fit found (fit on characters that training has not seen, and never on `test`)
// Returns the measures as text.
std::string save_calibration(const std::filesystem::path& folder, const std::filesystem::path& data, const std::string& split,
                             const infer::RignetModels& models, const pipelines::RignetOptions& options);

}  // namespace osteon::app
