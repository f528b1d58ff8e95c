// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <chrono>
#include <string>
#include <string_view>

#include "osteon/base/progress.h"
#include "osteon/pipelines/rig_report.h"

namespace osteon::pipelines {

// Runs the stages one after the other: tells the progress, and notes how long each took.
class Stages {
 public:
  Stages(RigReport& report, const Progress& progress) : report_(report), progress_(progress) {}

  template <class Work>
  auto run(std::string_view name, const Work& work) {
    constexpr double kStages = 20.0;
    if (progress_) progress_(name, std::min(1.0, static_cast<double>(report_.stages.size()) / kStages));
    const auto start = std::chrono::steady_clock::now();
    auto result = work();
    report_.stages.push_back({std::string(name), std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count()});
    return result;
  }

 private:
  RigReport& report_;
  const Progress& progress_;
};

}  // namespace osteon::pipelines
