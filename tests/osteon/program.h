// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "support/program.h"

namespace osteon::test {

// Runs `osteon ARGUMENTS` through the shell in the folder.
inline Outcome osteon(const TemporaryFolder& folder, const std::string& arguments) {
  return run_in(folder, fmt::format("{} {}", OSTEON_PROGRAM, arguments));
}

}  // namespace osteon::test
