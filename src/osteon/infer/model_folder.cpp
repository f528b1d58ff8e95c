// SPDX-License-Identifier: Apache-2.0
#include "osteon/infer/model_folder.h"

#include <fmt/ranges.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "osteon/base/error.h"

namespace osteon::infer {

namespace fs = std::filesystem;

fs::path find_models(std::string_view system) {
  const char* const variable = std::getenv("OSTEON_MODELS");
  std::error_code unknown;  // no /proc: the program's folder is then the current one
  const fs::path program = fs::read_symlink("/proc/self/exe", unknown);
  return find_models(system, variable ? std::optional<fs::path>(variable) : std::nullopt, program.parent_path());
}

fs::path find_models(std::string_view system, const std::optional<fs::path>& from_environment, const fs::path& program_folder) {
  std::vector<fs::path> places;
  if (from_environment) {
    places = {*from_environment};
  } else {
    places = {program_folder / "../share/osteon/models", program_folder / "models"};
    fs::path above = program_folder;
    for (int i = 0; i < 3; ++i) places.push_back((above = above.parent_path()) / "models");
  }
  std::vector<std::string> tried;
  for (const fs::path& place : places) {
    const fs::path folder = (place / system).lexically_normal();
    if (fs::is_directory(folder)) return folder;
    tried.push_back(folder.string());
  }
  throw Error("no weights of '{}'{}: looked for the folder\n  {}", system, from_environment ? " (OSTEON_MODELS is set)" : "",
              fmt::join(tried, "\n  "));
}

}  // namespace osteon::infer
