// SPDX-License-Identifier: Apache-2.0
#include "../../apps/interrupt.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace osteon::app {
namespace {

struct sigaction action_of(int signal) {
  struct sigaction now {};
  ::sigaction(signal, nullptr, &now);
  return now;
}

// In a process of its own.
int note_two() {
  catch_interrupts();
  stack_t stack{};
  ::sigaltstack(nullptr, &stack);
  for (const int signal : {SIGINT, SIGTERM}) {
    interrupted = 0;
    if (!(action_of(signal).sa_flags & SA_ONSTACK) || (stack.ss_flags & SS_DISABLE)) return 1;
    std::raise(signal);
    if (!interrupted || action_of(signal).sa_handler != SIG_DFL) return 2;
  }
  return 0;
}

TEST(Interrupt, is_noted_on_a_stack_of_its_own_and_the_second_one_ends_the_program) {
  EXPECT_EXIT(std::exit(note_two()), testing::ExitedWithCode(0), "");
  const auto end = [] {
    note_two();
    std::raise(SIGTERM);
  };
  EXPECT_EXIT(end(), testing::KilledBySignal(SIGTERM), "");
}

}  // namespace
}  // namespace osteon::app
