// SPDX-License-Identifier: Apache-2.0
#include "rig_job.h"

#include "choice.h"
#include "commands.h"
#include "given_skeleton.h"
#include "load_options.h"
#include "load_upright.h"
#include "naming.h"
#include "osteon/io/rigtxt.h"
#include "osteon/io/texture_files.h"
#include "preview.h"

namespace osteon::app {
namespace {

namespace fs = std::filesystem;
using Warn = std::function<void(const std::string&)>;

void add_skeleton_options(CLI::App& command, RigOptions& options) {
  auto& rignet = options.rignet;
  auto* detail = command.add_option("--detail", rignet.detail, "How many joints to find: 0 few .. 1 many")
                     ->check(CLI::Range(0.0f, 1.0f))
                     ->capture_default_str();
  auto* bandwidth = command.add_option("--bandwidth", rignet.bandwidth, "The same as RigNet's mean shift bandwidth")
                        ->check(CLI::Range(pipelines::kFinestBandwidth, pipelines::kCoarsestBandwidth));
  auto* joints = command.add_option("--joints", rignet.joints, "The same as about how many joints")->check(CLI::Range(1, 254));
  auto* skeleton = command.add_option("--skeleton", options.skeleton, "Use this file's skeleton as it is, only find the skin weights")
                       ->type_name("FILE");
  detail->excludes(bandwidth)->excludes(joints)->excludes(skeleton);
  bandwidth->excludes(joints)->excludes(skeleton);
  joints->excludes(skeleton);
  add_choice(command, "--fingers", rignet.fingers, {{"auto", pipelines::Fingers::automatic}, {"off", pipelines::Fingers::off}},
             "Rig the fingers of hands that have them, at --detail 0.4 and more (auto) or never (off)");
  add_choice(command, "--symmetry", rignet.symmetry, {{"auto", pipelines::Symmetry::automatic}, {"off", pipelines::Symmetry::off}},
             "Make the skeleton symmetric where the mesh is (auto) or never (off)");
}

void pass_on(const Warn& warn, const fs::path& file, const std::vector<std::string>& messages) {
  for (const std::string& message : messages) warn(fmt::format("{}: {}", file.string(), message));
}

pipelines::RignetOptions pipeline_options(const RigOptions& options, const io::Asset& asset, const std::optional<GivenSkeleton>& given) {
  auto out = options.rignet;
  if (options.load.up || asset.up != io::UpAxis::y) out.up = pipelines::Up::y;  // the file was read so that y is up
  out.skin.max_influences = static_cast<std::size_t>(options.save.max_influences);
  if (given) out.skeleton = given->in_place();
  return out;
}

// A rig that the program does not trust itself is not written at all.
void refuse_if_poor(const fs::path& input, float confidence, float least) {
  if (confidence < least)
    throw Refused("{}: the confidence in this rig is {:.2f}, less than {:.2f}; nothing was written (see --min-confidence)", input.string(),
                  confidence, least);
}

// rig.txt knows vertices by number only: the mesh goes beside it as an OBJ, in the same order.
fs::path obj_beside(fs::path rigtxt) { return rigtxt.replace_extension(".obj"); }

// Returns what that changed in the asset.
std::vector<std::string> write_rig(const RigOutputs& outputs, const RigOptions& options, const io::Asset& asset,
                                   const std::optional<GivenSkeleton>& given, const pipelines::RignetResult& result) {
  std::vector<std::string> changes = given ? io::save_glb(outputs.glb, asset, given->file, given->fit.to_body, result.weights, options.save)
                                           : io::save_glb(outputs.glb, asset, result.skeleton, result.weights, options.save);
  if (outputs.rigtxt) {
    io::save_rigtxt(*outputs.rigtxt, result.skeleton, result.weights);
    io::save_obj(obj_beside(*outputs.rigtxt), asset.mesh);
  }
  if (outputs.preview) save_preview(*outputs.preview, asset.mesh, &result.skeleton, &result.weights, 1);
  return changes;
}

}  // namespace

void RigOptions::add_to(CLI::App& command) {
  add_skeleton_options(command, *this);
  command.add_option("--max-influences", save.max_influences, "Joints that may move one vertex")
      ->check(CLI::Range(1, 8))
      ->capture_default_str();
  command.add_option("--min-confidence", min_confidence, "Write nothing, and exit with 3, below this (0..1)")
      ->check(CLI::Range(0.0f, 1.0f))
      ->capture_default_str();
  add_load_options(command, load);
  models.add_to(command);
}

void RigOutputs::check(const fs::path& input, const RigOptions& options, const std::optional<fs::path>& report) const {
  std::vector<fs::path> inputs{input};
  if (options.skeleton) inputs.push_back(*options.skeleton);
  std::vector<Output> outputs{{"-o", glb, ".glb"}};
  if (preview) outputs.push_back({"--preview", *preview, ".png"});
  if (report) outputs.push_back({"--report", *report, ".json"});
  if (rigtxt) {
    outputs.push_back({"--rigtxt", *rigtxt, ".txt"});
    const fs::path obj = obj_beside(*rigtxt);
    if (fs::exists(obj) && !fs::exists(*rigtxt)) inputs.push_back(obj);  // not of an earlier rig.txt, so it is the user's
    outputs.push_back({"--rigtxt with the mesh", obj, ".obj"});
  }
  check_outputs(inputs, outputs);
}

void rig_file(const fs::path& input, const RigOutputs& outputs, const RigOptions& options, const infer::RignetModels& models,
              const Warn& warn, const Look& look) {
  io::Asset asset = load_upright(input, options.load);
  if (outputs.preview) check_outputs(io::texture_files(asset), {{"--preview", *outputs.preview, ".png"}});
  pass_on(warn, input, asset.repairs);
  std::optional<GivenSkeleton> given;
  if (options.skeleton) given = load_given_skeleton(*options.skeleton, asset.mesh);
  const auto how = pipeline_options(options, asset, given);
  auto result = naming(input, [&] { return pipelines::rig_character(asset.mesh, models, how); });
  stand_up(asset, result);
  pipelines::RigReport& report = result.report;
  if (given && !given->fit.note.empty())
    report.warnings.insert(report.warnings.begin(), fmt::format("--skeleton {}: {}", options.skeleton->string(), given->fit.note));
  pass_on(warn, input, report.repairs);
  pass_on(warn, input, report.warnings);
  report.repairs.insert(report.repairs.begin(), asset.repairs.begin(), asset.repairs.end());
  std::vector<std::string> changes;
  if (report.confidence >= options.min_confidence) changes = write_rig(outputs, options, asset, given, result);
  pass_on(warn, outputs.glb, changes);
  look(report, changes);
  refuse_if_poor(input, report.confidence, options.min_confidence);
}

}  // namespace osteon::app
