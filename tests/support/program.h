// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>

#include "support/expect.h"

namespace osteon::test {

inline std::string content(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

struct Outcome {
  int code;
  std::string out, err;
};

// Runs a command through the shell in the folder.
inline Outcome run_in(const TemporaryFolder& folder, const std::string& command) {
  const int status = std::system(fmt::format("cd {}; exec >out.txt 2>err.txt; {}", folder.path().string(), command).c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content(folder / "out.txt"), content(folder / "err.txt")};
}

// What the folder holds, but for what the last command said.
inline std::map<std::filesystem::path, std::string> files_of(const TemporaryFolder& folder) {
  std::map<std::filesystem::path, std::string> out;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
    if (const auto name = entry.path().filename(); name != "out.txt" && name != "err.txt") out[name] = content(entry.path());
  return out;
}

}  // namespace osteon::test
