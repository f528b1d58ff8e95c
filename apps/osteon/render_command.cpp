// SPDX-License-Identifier: Apache-2.0
#include <CLI/CLI.hpp>

#include "commands.h"

namespace osteon::app {

void add_render_command(CLI::App& app) { app.add_subcommand("render", "Draw a character into a PNG picture"); }

}  // namespace osteon::app
