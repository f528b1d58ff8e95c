// SPDX-License-Identifier: Apache-2.0
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>

#include "../outputs.h"
#include "commands.h"
#include "given_skeleton.h"
#include "load_options.h"
#include "load_upright.h"
#include "model_options.h"
#include "naming.h"
#include "osteon/io/texture_files.h"
#include "osteon/pipelines/skin_character.h"
#include "preview.h"
#include "rigged_file.h"
#include "skin_report.h"

namespace osteon::app {
namespace {

const std::map<std::string, skin::Method> kMethods{{"rigid", skin::Method::rigid},
                                                   {"geovoxel", skin::Method::geovoxel},
                                                   {"heat", skin::Method::heat},
                                                   {"biharmonic", skin::Method::biharmonic},
                                                   {"transfer", skin::Method::transfer}};

struct SkinArguments {
  std::filesystem::path input, output;
  std::optional<std::filesystem::path> skeleton, from, preview, report;
  std::string method = "geovoxel";
  std::vector<std::string> locked;
  bool deform_islands = false;
  ModelOptions models;
  io::LoadOptions load;
  io::SaveOptions save;
  pipelines::SkinCharacterOptions options;
};

void warn(const std::filesystem::path& file, const std::vector<std::string>& messages) {
  for (const std::string& message : messages) spdlog::warn("{}: {}", file.string(), message);
}

// The skeleton to bind to: another file's, or the body's own.
GivenSkeleton choose_skeleton(const SkinArguments& arguments, const io::Asset& body) {
  if (!arguments.skeleton) {
    if (!body.skeleton) throw Error("{}: has no skeleton; expected one, or --skeleton FILE", arguments.input.string());
    return {{*body.skeleton, nullptr}, {}};
  }
  GivenSkeleton given = load_given_skeleton(*arguments.skeleton, body.mesh);
  if (!given.fit.note.empty()) spdlog::warn("{}: {}", arguments.skeleton->string(), given.fit.note);
  return given;
}

JointId joint_named(const Skeleton& skeleton, const std::string& name) {
  const auto found = std::ranges::find(skeleton.names, name);
  if (found == skeleton.names.end()) throw Error("--lock {}: the skeleton has no joint of that name", name);
  return static_cast<JointId>(found - skeleton.names.begin());
}

void lock_joints(const SkinArguments& arguments, const io::Asset& body, const Skeleton& skeleton, skin::BindOptions& bind) {
  if (arguments.locked.empty()) return;
  if (!body.weights || !body.skeleton) throw Error("--lock: {} has no skin weights to keep", arguments.input.string());
  for (const std::string& name : arguments.locked) {
    joint_named(*body.skeleton, name);
    bind.locked.push_back(joint_named(skeleton, name));
  }
  const PerJoint<JointId> number = skin::joints_by_name(*body.skeleton, skeleton);
  SkinWeights before;
  for (VertexId v : body.mesh.positions.ids()) {
    std::vector<Influence> row((*body.weights)[v].begin(), (*body.weights)[v].end());
    for (Influence& i : row) i.joint = number[i.joint];
    before.append(row);
  }
  bind.before = std::move(before);
}

skin::Binding bound(const SkinArguments& arguments, const io::Asset& body, const Skeleton& skeleton) {
  pipelines::SkinCharacterOptions options = arguments.options;
  options.bind.max_influences = static_cast<std::size_t>(arguments.save.max_influences);
  if (arguments.deform_islands) options.bind.islands = skin::Islands::deform;
  lock_joints(arguments, body, skeleton, options.bind);
  const auto run = [&] { return naming(arguments.input, [&] { return pipelines::skin_character(body.mesh, skeleton, options); }); };
  if (arguments.from) options.bind.from = load_rig(*arguments.from);
  if (arguments.method == "rignet" || arguments.method == "networks") {
    const infer::RignetModels models = arguments.models.load();
    options.rignet = &models;
    if (arguments.method == "networks" && !(options.neuroskinning = models.neuroskinning()))
      throw Error("--method networks: the models have no neuroskinning.safetensors, expected both networks (or --method rignet)");
    return run();
  }
  if (arguments.method == "neuroskinning") {
    const infer::NeuroskinningModel model = arguments.models.load_neuroskinning();
    options.neuroskinning = &model;
    return run();
  }
  options.bind.method = kMethods.at(arguments.method);
  return run();
}

void check(const SkinArguments& arguments) {
  if ((arguments.method == "transfer") != arguments.from.has_value())
    throw Error("--method {}: {}", arguments.method,
                arguments.from ? "--from is for --method transfer" : "needs --from FILE, the rigged reference");
  std::vector<std::filesystem::path> inputs{arguments.input};
  for (const auto* file : {&arguments.skeleton, &arguments.from})
    if (*file) inputs.push_back(**file);
  std::vector<Output> outputs{{"-o", arguments.output, ".glb"}};
  if (arguments.preview) outputs.push_back({"--preview", *arguments.preview, ".png"});
  if (arguments.report) outputs.push_back({"--report", *arguments.report, ".json"});
  check_outputs(inputs, outputs);
}

void save_report(const SkinArguments& arguments, const Rig& rig, const skin::Binding& binding, const GivenSkeleton& given,
                 const std::vector<std::string>& changes) {
  nlohmann::ordered_json json{{"osteon", OSTEON_VERSION},
                              {"input", arguments.input.string()},
                              {"method", arguments.method},
                              {"vertices", rig.mesh.positions.size()},
                              {"joints", rig.skeleton.size()},
                              {"skeleton_fit", given.fit.note},
                              {"rigid_islands", binding.rigid_islands}};
  json.update(to_json(pipelines::skin_quality(rig), rig.skeleton));
  json["notes"] = binding.notes;
  json["repairs"] = binding.repairs;
  json["changes"] = changes;
  write_json(*arguments.report, json);
}

void skin_body(const SkinArguments& arguments) {
  check(arguments);
  const io::Asset body = load_upright(arguments.input, arguments.load);
  if (arguments.preview) check_outputs(io::texture_files(body), {{"--preview", *arguments.preview, ".png"}});
  warn(arguments.input, body.repairs);
  if (!arguments.skeleton || !arguments.locked.empty()) warn(arguments.input, body.rig_repairs);
  const GivenSkeleton given = choose_skeleton(arguments, body);
  Rig rig{body.mesh, given.in_place(), {}};
  skin::Binding binding = bound(arguments, body, rig.skeleton);
  rig.weights = binding.weights;
  warn(arguments.input, binding.notes);
  const std::vector<std::string> changes =
      !arguments.skeleton ? io::save_weights(arguments.output, body, rig.weights, arguments.save)
                          : io::save_glb(arguments.output, body, given.file, given.fit.to_body, rig.weights, arguments.save);
  warn(arguments.output, changes);
  binding.repairs.insert(binding.repairs.begin(), body.repairs.begin(), body.repairs.end());
  if (arguments.report) save_report(arguments, rig, binding, given, changes);
  if (arguments.preview) save_preview(*arguments.preview, rig.mesh, &rig.skeleton, &rig.weights, 1);
  spdlog::info("{}: {} vertices bound to {} joints ({})", arguments.output.string(), rig.mesh.positions.size(), rig.skeleton.size(),
               arguments.method);
}

void add_method_options(CLI::App& command, SkinArguments& arguments) {
  std::vector<std::string> names{"networks", "rignet", "neuroskinning"};
  for (const auto& [name, method] : kMethods) names.push_back(name);
  command
      .add_option("--method", arguments.method,
                  "How to bind: geodesic voxels, bone heat, biharmonic, nearest bone, another mesh's weights, or networks (RigNet's, "
                  "NeuroSkinning's, or both heard together as `rig` does)")
      ->check(CLI::IsMember(names))
      ->capture_default_str();
  command.add_option("--from", arguments.from, "For --method transfer: the rigged mesh whose weights to take")->type_name("FILE");
  auto& bind = arguments.options.bind;
  command.add_option("--smooth", bind.smooth, "Rounds of smoothing (default: what suits the method)")->check(CLI::Range(0, 100));
  command.add_option("--prune", bind.prune_share, "Weights below this share of a vertex's largest go (default: what suits the method)")
      ->check(CLI::Range(0.0f, 1.0f));
  command.add_option("--max-influences", arguments.save.max_influences, "Joints that may move one vertex")
      ->check(CLI::Range(1, 8))
      ->capture_default_str();
  command.add_option("--lock", arguments.locked, "Joints that keep the weights they have in the input, separated by commas")
      ->delimiter(',')
      ->type_name("JOINT");
  command.add_flag("--mirror", arguments.options.mirror, "Make the halves of a symmetric character equal");
  command.add_flag("--deform-islands", arguments.deform_islands, "Let small separate parts (buttons, eyes) bend, too");
}

}  // namespace

void add_skin_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand("skin", "Bind a mesh to a skeleton that is there already");
  auto arguments = std::make_shared<SkinArguments>();
  command->add_option("input", arguments->input, "The character: GLB, glTF, OBJ, PLY, STL, FBX, DAE, rig.txt or 3DS")
      ->required()
      ->type_name("FILE");
  command->add_option("--skeleton", arguments->skeleton, "The skeleton, any of these formats (default: the character's own)")
      ->type_name("FILE");
  command->add_option("-o,--output", arguments->output, "The GLB to write")->required()->type_name("FILE");
  command->add_option("--preview", arguments->preview, "Also draw a picture (PNG)")->type_name("FILE");
  command->add_option("--report", arguments->report, "Also write coverage, leak, smoothness, symmetry and deformation (JSON)")
      ->type_name("FILE");
  add_method_options(*command, *arguments);
  add_load_options(*command, arguments->load);
  arguments->models.add_to(*command);
  command->callback([arguments] { skin_body(*arguments); });
}

}  // namespace osteon::app
