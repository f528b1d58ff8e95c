// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

namespace osteon::infer {

// The folder of a system's weights, such as "rignet": in $OSTEON_MODELS if that is set; else beside the program: in
// ../share/osteon/models (installed), in models, or in the models of a folder up to three above it (a source tree).
// Throws Error that lists where it looked.
std::filesystem::path find_models(std::string_view system);

// The same for a given environment and place of the program.
std::filesystem::path find_models(std::string_view system, const std::optional<std::filesystem::path>& from_environment,
                                  const std::filesystem::path& program_folder);

}  // namespace osteon::infer
