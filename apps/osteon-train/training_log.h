// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdio>
#include <filesystem>
#include <fstream>

#include "osteon/train/trainer.h"

namespace osteon::app {

// Shows how training goes: on stderr (one line that is kept up to date on a terminal, else one line a report) and as JSON lines in a file.
class TrainingLog {
 public:
  enum class Shown { here_and_in_file, in_file_alone };

  // Appends to `file` where it is not empty. Throws Error when that cannot be opened or holds something else.
  explicit TrainingLog(const std::filesystem::path& file, Shown shown = Shown::here_and_in_file);

  void operator()(const train::TrainReport& report);

 private:
  Shown shown_;
  std::ofstream file_;
  bool terminal_;
};

// The table of --profile, on stderr.
void print_profile(const train::StepProfile& profile);

}  // namespace osteon::app
