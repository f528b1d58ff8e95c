// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <unistd.h>

#include <cstddef>
#include <cstdio>
#include <mutex>
#include <string>

namespace osteon::app {

// "preparing train 17/404" on stderr, kept in one line; nothing where stderr is not a terminal. May be advanced from any thread.
class ProgressLine {
 public:
  ProgressLine(std::string text, std::size_t total) : text_(std::move(text)), total_(total), shown_(::isatty(STDERR_FILENO) != 0) {}
  ~ProgressLine() {
    if (shown_) std::fputs("\r\033[K", stderr);
  }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void advance() {
    const std::lock_guard lock(mutex_);
    ++done_;
    if (shown_) std::fprintf(stderr, "\r\033[K%s %zu/%zu", text_.c_str(), done_, total_);
  }

 private:
  std::string text_;
  std::size_t total_, done_ = 0;
  bool shown_;
  std::mutex mutex_;
};

}  // namespace osteon::app
