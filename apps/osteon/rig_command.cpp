// SPDX-License-Identifier: Apache-2.0
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <memory>

#include "commands.h"
#include "load_options.h"
#include "model_options.h"
#include "osteon/io/rigtxt.h"
#include "osteon/io/save.h"
#include "osteon/pipelines/confidence_fit.h"
#include "osteon/pipelines/rignet.h"
#include "preview.h"
#include "rig_report.h"

namespace osteon::app {
namespace {

struct RigArguments {
  std::filesystem::path input, output;
  std::optional<std::filesystem::path> preview, report, rigtxt, skeleton;
  ModelOptions models;
  float min_confidence = pipelines::kLowConfidence;
  io::LoadOptions load;
  io::SaveOptions save;
  pipelines::RignetOptions rignet;
};

void warn(const std::filesystem::path& file, const std::vector<std::string>& messages) {
  for (const std::string& message : messages) spdlog::warn("{}: {}", file.string(), message);
}

pipelines::RignetOptions pipeline_options(const RigArguments& arguments) {
  auto options = arguments.rignet;
  options.skin.max_influences = static_cast<std::size_t>(arguments.save.max_influences);
  if (arguments.skeleton) options.skeleton = io::load_skeleton(*arguments.skeleton, arguments.load);
  return options;
}

// A rig that the program does not trust itself is not written at all.
void refuse_if_poor(const RigArguments& arguments, const pipelines::RigReport& report) {
  if (report.confidence < arguments.min_confidence)
    throw Refused("{}: the confidence in this rig is {:.2f}, less than {:.2f}; nothing was written (see --min-confidence)",
                  arguments.input.string(), report.confidence, arguments.min_confidence);
}

// rig.txt knows vertices by number only: the mesh goes beside it as an OBJ, in the same order.
std::filesystem::path obj_beside(std::filesystem::path rigtxt) { return rigtxt.replace_extension(".obj"); }

void check_outputs(const RigArguments& arguments) {
  std::error_code missing;  // a file that is not there is not the input
  if (arguments.rigtxt && std::filesystem::equivalent(obj_beside(*arguments.rigtxt), arguments.input, missing))
    throw Error("--rigtxt {}: {} beside it is the input and would be overwritten; choose another name", arguments.rigtxt->string(),
                obj_beside(*arguments.rigtxt).string());
}

void write_rig(const RigArguments& arguments, const io::Asset& asset, const pipelines::RignetResult& result) {
  warn(arguments.output, io::save_glb(arguments.output, asset, result.skeleton, result.weights, arguments.save));
  if (arguments.rigtxt) {
    io::save_rigtxt(*arguments.rigtxt, result.skeleton, result.weights);
    io::save_obj(obj_beside(*arguments.rigtxt), asset.mesh);
  }
  if (arguments.preview) save_preview(*arguments.preview, asset.mesh, &result.skeleton, &result.weights, 1);
}

void rig(const RigArguments& arguments) {
  check_outputs(arguments);
  const io::Asset asset = io::load(arguments.input, arguments.load);
  warn(arguments.input, asset.repairs);
  const auto models = arguments.models.load();
  const auto result = pipelines::rig_character(asset.mesh, models, pipeline_options(arguments));
  warn(arguments.input, result.report.repairs);
  warn(arguments.input, result.report.warnings);
  if (arguments.report) save_report(*arguments.report, result.report, arguments.input);
  refuse_if_poor(arguments, result.report);
  write_rig(arguments, asset, result);
  spdlog::info("{}: {} vertices, {} joints, confidence {:.2f}", arguments.output.string(), result.report.vertices, result.report.joints,
               result.report.confidence);
}

void add_file_options(CLI::App& command, RigArguments& arguments) {
  command.add_option("input", arguments.input, "The character: GLB, glTF, OBJ, PLY, STL, FBX, DAE, rig.txt or 3DS")
      ->required()
      ->type_name("FILE");
  command.add_option("-o,--output", arguments.output, "The GLB to write")->required()->type_name("FILE");
  command.add_option("--preview", arguments.preview, "Also draw a picture (PNG)")->type_name("FILE");
  command.add_option("--rigtxt", arguments.rigtxt, "Also write RigNet's rig.txt, with the OBJ beside it")->type_name("FILE");
  command.add_option("--report", arguments.report, "Also write how it came about (JSON)")->type_name("FILE");
}

void add_skeleton_options(CLI::App& command, RigArguments& arguments) {
  auto& rignet = arguments.rignet;
  auto* detail = command.add_option("--detail", rignet.detail, "How many joints to find: 0 few .. 1 many")
                     ->check(CLI::Range(0.0f, 1.0f))
                     ->capture_default_str();
  auto* bandwidth = command.add_option("--bandwidth", rignet.bandwidth, "The same as RigNet's mean shift bandwidth")
                        ->check(CLI::Range(pipelines::kFinestBandwidth, pipelines::kCoarsestBandwidth));
  auto* joints = command.add_option("--joints", rignet.joints, "The same as about how many joints")->check(CLI::Range(1, 254));
  auto* skeleton = command.add_option("--skeleton", arguments.skeleton, "Use this file's skeleton as it is, only find the skin weights")
                       ->type_name("FILE");
  detail->excludes(bandwidth)->excludes(joints)->excludes(skeleton);
  bandwidth->excludes(joints)->excludes(skeleton);
  joints->excludes(skeleton);
  static const std::map<std::string, pipelines::Symmetry> symmetries{{"auto", pipelines::Symmetry::automatic},
                                                                     {"off", pipelines::Symmetry::off}};
  command.add_option("--symmetry", rignet.symmetry, "Make the skeleton symmetric where the mesh is (auto) or never (off)")
      ->transform(CLI::CheckedTransformer(symmetries))
      ->type_name("auto|off")
      ->default_str("auto");
}

}  // namespace

void add_rig_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand("rig", "Give a mesh a skeleton and skin weights");
  auto arguments = std::make_shared<RigArguments>();
  add_file_options(*command, *arguments);
  add_skeleton_options(*command, *arguments);
  command->add_option("--max-influences", arguments->save.max_influences, "Joints that may move one vertex")
      ->check(CLI::Range(1, 8))
      ->capture_default_str();
  command->add_option("--min-confidence", arguments->min_confidence, "Write nothing, and exit with 3, below this (0..1)")
      ->check(CLI::Range(0.0f, 1.0f))
      ->capture_default_str();
  add_load_options(*command, arguments->load);
  arguments->models.add_to(*command);
  command->callback([arguments] { rig(*arguments); });
}

}  // namespace osteon::app
