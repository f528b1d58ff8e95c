// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "osteon/synth/character.h"
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

// Runs `osteon-train ARGUMENTS` through the shell in the folder.
inline Outcome osteon_train(const test::TemporaryFolder& folder, const std::string& arguments) {
  const std::string command = fmt::format("cd {}; exec >out.txt 2>err.txt; export OSTEON_MODELS={}; {} {}", folder.path().string(),
                                          OSTEON_MODELS_FOLDER, OSTEON_TRAIN_PROGRAM, arguments);
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, content(folder / "out.txt"), content(folder / "err.txt")};
}

// Of characters that are made quickly.
inline synth::CharacterOptions coarse() {
  synth::CharacterOptions options;
  options.cells = 40;
  return options;
}

}  // namespace osteon::test
