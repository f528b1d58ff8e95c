// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

namespace osteon::app {

// curves: logs of training as a diagram
void add_curves_command(CLI::App& app);

}  // namespace osteon::app
