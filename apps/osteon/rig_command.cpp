// SPDX-License-Identifier: Apache-2.0
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "rig_job.h"
#include "rig_report.h"

namespace osteon::app {
namespace {

struct RigArguments {
  std::filesystem::path input;
  RigOutputs outputs;
  std::optional<std::filesystem::path> report;
  RigOptions options;
};

void rig(const RigArguments& arguments) {
  arguments.outputs.check(arguments.input, arguments.options, arguments.report);
  pipelines::RigReport report;
  const auto look = [&](const pipelines::RigReport& seen, const std::vector<std::string>& changes) {
    report = seen;
    if (!arguments.report) return;
    nlohmann::ordered_json json{{"osteon", OSTEON_VERSION}, {"input", arguments.input.string()}};
    json.update(to_json(report, changes));
    save_json(*arguments.report, json);
  };
  const auto models = arguments.options.models.load();
  rig_file(
      arguments.input, arguments.outputs, arguments.options, models, [](const std::string& message) { spdlog::warn(message); }, look);
  spdlog::info("{}: {} vertices, {} joints, confidence {:.2f}", arguments.outputs.glb.string(), report.vertices, report.joints,
               report.confidence);
}

}  // namespace

void add_rig_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand("rig", "Give a mesh a skeleton and skin weights");
  auto arguments = std::make_shared<RigArguments>();
  command->add_option("input", arguments->input, "The character: GLB, glTF, OBJ, PLY, STL, FBX, DAE, rig.txt or 3DS")
      ->required()
      ->type_name("FILE");
  command->add_option("-o,--output", arguments->outputs.glb, "The GLB to write")->required()->type_name("FILE");
  command->add_option("--preview", arguments->outputs.preview, "Also draw a picture (PNG)")->type_name("FILE");
  command->add_option("--rigtxt", arguments->outputs.rigtxt, "Also write RigNet's rig.txt, with the OBJ beside it")->type_name("FILE");
  command->add_option("--report", arguments->report, "Also write how it came about (JSON)")->type_name("FILE");
  arguments->options.add_to(*command);
  command->callback([arguments] { rig(*arguments); });
}

}  // namespace osteon::app
