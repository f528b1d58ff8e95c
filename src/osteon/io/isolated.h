// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>

#include "osteon/io/bytes.h"

namespace osteon::io {

struct IsolationLimits {
  std::size_t memory;  // bytes on top of what this process has
  unsigned seconds;    // of computing
};

// Runs `work` in a forked process and returns its result: code of others that may crash, hang or exhaust memory on a malformed file cannot
// take this process with it. `work` must not use threads. Throws Error with the text of an exception that left `work`, or saying that
// the process crashed or went over a limit.
Bytes run_isolated(const std::function<Bytes()>& work, const IsolationLimits& limits);

}  // namespace osteon::io
