// SPDX-License-Identifier: Apache-2.0
#include <fmt/ranges.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <memory>

#include "../kept_memory.h"
#include "commands.h"
#include "osteon/base/parallel.h"
#include "osteon/base/progress.h"

namespace {

enum ExitCode { done = 0, bad_input = 2, refused = 3, cancelled = 130 };

// Warnings and progress go to stderr, so that stdout stays free for what a command is asked to print.
void send_messages_to_stderr() {
  auto logger = std::make_shared<spdlog::logger>("osteon", std::make_shared<spdlog::sinks::stderr_sink_st>());
  logger->set_pattern("%l: %v");
  spdlog::set_default_logger(std::move(logger));
}

// One line about what was typed. Where a command is missing, CLI11 says only that one is required.
std::string complaint(const CLI::App* app, const CLI::Error& e) {
  const std::vector<std::string> unknown = app->remaining(true);
  while (!app->get_subcommands().empty()) app = app->get_subcommands().front();
  if (app->get_require_subcommand_min() == 0) return e.what();
  std::vector<std::string> names;
  for (const CLI::App* command : app->get_subcommands({})) names.push_back(command->get_name());
  return fmt::format("{}expected a command: {}", unknown.empty() ? "" : unknown.front() + ": ", fmt::join(names, ", "));
}

void add_common_options(CLI::App& app) {
  app.set_version_flag("--version", "osteon " OSTEON_VERSION);
  app.add_option_function<int>(
         "--threads", [](const int& n) { osteon::set_threads(n); }, "Threads to use (default: all cores)")
      ->check(CLI::Range(1, 1024));
  app.add_flag_callback(
      "--quiet", [] { spdlog::set_level(spdlog::level::err); }, "Only say what went wrong");
  app.fallthrough();  // the common options may also stand behind the sub-command
  app.require_subcommand(1);
  app.failure_message(
      [](const CLI::App* program, const CLI::Error& e) { return fmt::format("error: {} (see --help)\n", complaint(program, e)); });
}

void add_commands(CLI::App& app) {
  osteon::app::add_rig_command(app);
  osteon::app::add_batch_command(app);
  osteon::app::add_skin_command(app);
  osteon::app::add_compare_command(app);
  osteon::app::add_render_command(app);
  osteon::app::add_synth_command(app);
  osteon::app::add_dataset_command(app);
  osteon::app::add_evaluate_command(app);
}

int run(int argc, char** argv) {
  CLI::App app{"Osteon rigs a character mesh: skeleton and skin weights", "osteon"};
  add_common_options(app);
  add_commands(app);
  try {
    app.parse(argc, argv);
    return done;
  } catch (const CLI::ParseError& e) {  // also --help and --version, which print and end well
    return app.exit(e) == 0 ? done : bad_input;
  }
}

// What a command was asked to print may not have arrived: a disk may be full.
void finish_printing() {
  if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0) throw osteon::Error("cannot write to the standard output");
}

}  // namespace

int main(int argc, char** argv) {
  osteon::app::keep_freed_memory();
  send_messages_to_stderr();
  try {
    const int code = run(argc, argv);
    finish_printing();
    return code;
  } catch (const osteon::app::Refused& e) {
    spdlog::error(e.what());
    return refused;
  } catch (const osteon::Cancelled&) {
    return cancelled;
  } catch (const std::bad_alloc&) {
    spdlog::error("not enough memory");
    return bad_input;
  } catch (const std::exception& e) {
    spdlog::error(e.what());
    return bad_input;
  }
}
