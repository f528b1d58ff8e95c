// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "osteon/infer/rignet.h"
#include "osteon/pipelines/rignet.h"

namespace osteon::app {

// The characters of a split whose skeletons came out worst (by IoU), as one picture: two in a row, each with the reference and then ours,
// from the front and from the side. Returns their names and measures as a numbered Markdown list in the same order.
std::string save_gallery(const std::filesystem::path& picture, const std::filesystem::path& data, const std::string& split,
                         const infer::RignetModels& models, const pipelines::RignetOptions& options);

}  // namespace osteon::app
