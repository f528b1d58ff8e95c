// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "osteon/base/error.h"

namespace osteon::app {

// A file that a command is asked to write.
struct Output {
  std::string option;  // that asks for it
  std::filesystem::path file;
  std::string extension;  // of files of its kind, in small letters; empty: any
};

inline bool is_same_file(const std::filesystem::path& a, const std::filesystem::path& b) {
  const auto place = [](const auto& file) { return std::filesystem::weakly_canonical(std::filesystem::absolute(file)); };
  std::error_code missing;  // a file that is not there yet is known by its place alone
  return std::filesystem::equivalent(a, b, missing) || place(a) == place(b);
}

// No command costs anybody a file: throws Error where an output has the name of another kind of file, would lie in no folder, or is one of
// the inputs or another output, under whatever name. Called before anything is written.
inline void check_outputs(std::vector<std::filesystem::path> inputs, const std::vector<Output>& outputs) {
  for (const auto& [option, file, kind] : outputs) {
    std::string extension = file.extension().string();
    std::ranges::transform(extension, extension.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (!kind.empty() && extension != kind) throw Error("{} {}: expected a name that ends in {}", option, file.string(), kind);
    if (std::filesystem::is_directory(file)) throw Error("{} {}: is a folder, expected a file", option, file.string());
    if (const auto folder = file.parent_path(); !folder.empty() && !std::filesystem::is_directory(folder))
      throw Error("{} {}: there is no folder {}", option, file.string(), folder.string());
    for (const auto& other : inputs)
      if (is_same_file(file, other))
        throw Error("{} {}: {} would be overwritten; choose another name", option, file.string(), other.string());
    inputs.push_back(file);
  }
}

// The same for commands that write after hours: also throws Error where no file can be made beside an output, as it is then written aside
// first.
inline void check_late_outputs(std::vector<std::filesystem::path> inputs, const std::vector<Output>& outputs) {
  check_outputs(std::move(inputs), outputs);
  for (const auto& [option, file, kind] : outputs) {
    const std::filesystem::path aside = file.string() + ".tmp";
    if (!std::ofstream(aside)) throw Error("{} {}: cannot be written", option, file.string());
    std::filesystem::remove(aside);
  }
}

}  // namespace osteon::app
