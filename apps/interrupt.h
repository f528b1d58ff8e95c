// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <csignal>

namespace osteon::app {

inline volatile std::sig_atomic_t interrupted = 0;

// From here on Ctrl-C and SIGTERM set `interrupted` instead of ending the program; a second one ends it.
inline void catch_interrupts() {
  const auto note = [](int signal) {
    interrupted = 1;
    std::signal(signal, SIG_DFL);
  };
  std::signal(SIGINT, note);
  std::signal(SIGTERM, note);
}

}  // namespace osteon::app
