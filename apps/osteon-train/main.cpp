// SPDX-License-Identifier: Apache-2.0
#include <c10/util/Exception.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>

#include "../kept_memory.h"
#include "curves_command.h"
#include "finetune_command.h"
#include "osteon/base/progress.h"
#include "rignet_command.h"

namespace {

// OpenMP's threads, which LibTorch computes with, turn in circles while they wait, and take the cores from those that make the next batches
// and from other programs: a step took up to ten times as long. OpenMP reads what it should do when a program is loaded, so this begins
// anew.
void let_waiting_threads_sleep(char** argv) {
  if (std::getenv("OMP_WAIT_POLICY")) return;
  ::setenv("OMP_WAIT_POLICY", "passive", 1);
  ::execv("/proc/self/exe", argv);  // where that fails, all works, only slower
}

enum ExitCode { done = 0, failed = 1, bad_input = 2, cancelled = 130 };

int run(int argc, char** argv) {
  CLI::App app{"Trains Osteon's networks", "osteon-train"};
  app.require_subcommand(1);
  app.failure_message([](const CLI::App*, const CLI::Error& e) { return fmt::format("error: {} (see --help)\n", e.what()); });
  osteon::app::add_curves_command(app);
  osteon::app::add_finetune_command(app);
  osteon::app::add_rignet_commands(app);
  try {
    app.parse(argc, argv);
    return done;
  } catch (const CLI::ParseError& e) {  // also --help, which prints and ends well
    return app.exit(e) == 0 ? done : bad_input;
  }
}

}  // namespace

int main(int argc, char** argv) {
  let_waiting_threads_sleep(argv);
  osteon::app::keep_freed_memory();
  try {
    return run(argc, argv);
  } catch (const osteon::Error& e) {
    std::fprintf(stderr, "error: %s\n", e.what());
    return bad_input;
  } catch (const osteon::Cancelled&) {
    return cancelled;
  } catch (const std::filesystem::filesystem_error& e) {
    std::fprintf(stderr, "error: %s\n", e.what());
    return bad_input;
  } catch (const c10::Error& e) {  // LibTorch's own, such as a GPU without memory left
    std::fprintf(stderr, "error: %s\n", e.what_without_backtrace());
    return failed;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "error: %s\n", e.what());
    return failed;
  }
}
