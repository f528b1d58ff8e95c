// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <signal.h>

#include <array>
#include <csignal>
#include <cstddef>

namespace osteon::app {

inline volatile std::sig_atomic_t interrupted = 0;

// From here on Ctrl-C and SIGTERM set `interrupted` instead of ending the program; a second one ends it. For the main thread, which is the
// one that signals to the program reach.
// They are noted on a stack of their own: while oneDNN multiplies, its kernels for AVX-512 hold a pointer to their data in the stack
// register, and what the system puts there for the handler would go into the heap.
inline void catch_interrupts() {
  static std::array<std::byte, 1 << 16> memory;  // the largest registers (AMX) take 11 kB
  stack_t stack{};
  stack.ss_sp = memory.data();
  stack.ss_size = memory.size();
  ::sigaltstack(&stack, nullptr);
  struct sigaction note {};
  note.sa_handler = [](int) { interrupted = 1; };
  note.sa_flags = SA_ONSTACK | SA_RESETHAND | SA_RESTART;
  for (const int signal : {SIGINT, SIGTERM}) ::sigaction(signal, &note, nullptr);
}

}  // namespace osteon::app
