// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/base/error.h"

namespace CLI {
class App;
}

// The sub-commands of the program `osteon`, one file each. A function adds its command to `app`; the work happens in the command's
// callback, which throws and never catches: main() turns what arrives there into a message and an exit code.
namespace osteon::app {

void add_rig_command(CLI::App& app);
void add_batch_command(CLI::App& app);
void add_skin_command(CLI::App& app);
void add_compare_command(CLI::App& app);
void add_render_command(CLI::App& app);
void add_synth_command(CLI::App& app);
void add_dataset_command(CLI::App& app);
void add_evaluate_command(CLI::App& app);

// The work was done, but the result is not good enough to be used: exit code 3.
class Refused : public Error {
 public:
  using Error::Error;
};

}  // namespace osteon::app
