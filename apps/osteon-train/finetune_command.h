// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

#include "osteon/base/error.h"

namespace osteon::app {

void add_finetune_command(CLI::App& app);

}  // namespace osteon::app
