// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "osteon/train/tasks.h"

namespace osteon::app {

// Lets the networks run on "cpu", "cuda" or "cuda:N". Throws Error for another name, and for a GPU where LibTorch finds none.
void choose_device(const std::string& name, train::RunOptions& run);

}  // namespace osteon::app
