// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>

#include "commands.h"

namespace osteon::app {

void add_rig_command(CLI::App& app) { app.add_subcommand("rig", "Give a mesh a skeleton and skin weights"); }

}  // namespace osteon::app
