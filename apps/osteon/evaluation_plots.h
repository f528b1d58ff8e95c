// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>

#include "osteon/infer/rignet.h"

namespace osteon::app {

// Diagrams of how the measures depend on what can be chosen, means over the characters of the split, as SVG files in `folder`:
//   tolerance.svg             joints found against how near is near enough
//   detail.svg, detail_distances.svg   skeletons against --detail
//   influences.svg, bones.svg          skin weights against how many joints may move a vertex, and out of how many near ones
void save_evaluation_plots(const std::filesystem::path& folder, const std::filesystem::path& data, const std::string& split,
                           const infer::RignetModels& models);

}  // namespace osteon::app
