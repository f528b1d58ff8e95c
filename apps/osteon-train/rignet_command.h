// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>

#include "osteon/base/error.h"

namespace osteon::app {

// rignet.votes, rignet.attention, rignet.joints, rignet.bones, rignet.root, rignet.skin
void add_rignet_commands(CLI::App& app);

}  // namespace osteon::app
