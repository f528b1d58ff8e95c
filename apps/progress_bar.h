// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <mutex>
#include <string>

namespace osteon::app {

// "votes  [########............]  41 %  what else there is to say" on stderr, kept in one line; nothing where stderr is not a terminal.
// May be used from any thread.
class ProgressBar {
 public:
  ProgressBar() : shown_(::isatty(STDERR_FILENO) != 0) {}
  ~ProgressBar() {
    if (shown_) std::fputs("\r\033[K", stderr);
  }
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void show(const std::string& stage, double share, const std::string& remark = "") {
    if (!shown_) return;
    const std::lock_guard lock(mutex_);
    constexpr std::size_t width = 30;
    const auto filled = static_cast<std::size_t>(std::clamp(share, 0.0, 1.0) * width);
    const std::string bar = std::string(filled, '#') + std::string(width - filled, '.');
    std::fprintf(stderr, "\r\033[K%-10s [%s] %3.0f %%  %s", stage.c_str(), bar.c_str(), 100.0 * share, remark.c_str());
    std::fflush(stderr);
  }

 private:
  bool shown_;
  std::mutex mutex_;
};

}  // namespace osteon::app
