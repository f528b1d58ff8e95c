// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <stdexcept>
#include <string_view>

namespace osteon {

// Long work calls this with what it is doing and the share done, 0..1. It may throw Cancelled to stop the work.
using Progress = std::function<void(std::string_view stage, double done)>;

struct Cancelled : std::runtime_error {
  Cancelled() : std::runtime_error("cancelled") {}
};

}  // namespace osteon
