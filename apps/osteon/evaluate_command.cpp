// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <fstream>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "../numbers.h"
#include "../outputs.h"
#include "calibration.h"
#include "choice.h"
#include "commands.h"
#include "evaluation.h"
#include "evaluation_plots.h"
#include "gallery.h"
#include "model_options.h"
#include "naming.h"
#include "osteon/metrics/score_table.h"
#include "rigged_file.h"
#include "skin_methods.h"

namespace osteon::app {
namespace {

struct EvaluateArguments {
  std::filesystem::path predicted, reference, data, json;
  std::filesystem::path gallery, plots, calibration;
  ModelOptions models;
  std::string split = "val", task = "all";
  int turn = 0;  // quarter turns
  io::UpAxis up = io::UpAxis::y;
  float scale = 1.0f;
  pipelines::RignetOptions options;
  std::vector<std::string> without;
};

const std::vector<metrics::ScoreColumn> kSkeletonColumns{{"iou", "IoU %", 100, 1},
                                                         {"precision", "precision %", 100, 1},
                                                         {"recall", "recall %", 100, 1},
                                                         {"cd_j2j", "CD-J2J %", 100, 2},
                                                         {"cd_j2b", "CD-J2B %", 100, 2},
                                                         {"cd_b2b", "CD-B2B %", 100, 2},
                                                         {"tree_edit_distance", "edit distance", 1, 1}};
const std::vector<metrics::ScoreColumn> kSkinColumns{{"precision", "precision %", 100, 1},
                                                     {"recall", "recall %", 100, 1},
                                                     {"l1", "L1", 1, 3},
                                                     {"mean_distance", "mean distance", 1, 4},
                                                     {"max_distance", "max distance", 1, 3}};

const std::vector<metrics::ScoreColumn> kConnectivityColumns{{"accuracy", "pairs right %", 100, 1},
                                                             {"precision", "precision %", 100, 1},
                                                             {"recall", "recall %", 100, 1},
                                                             {"bones", "tree's bones right %", 100, 1},
                                                             {"tree_edit_distance", "edit distance", 1, 2},
                                                             {"likeliest_root", "likeliest root %", 100, 1},
                                                             {"root", "tree's root %", 100, 1}};

std::vector<double> values(const metrics::SkeletonScores& s) {
  return {s.iou, s.precision, s.recall, s.cd_j2j, s.cd_j2b, s.cd_b2b, s.tree_edit_distance};
}
std::vector<double> values(const metrics::SkinScores& s) { return {s.precision, s.recall, s.l1, s.mean_distance, s.max_distance}; }
std::vector<double> values(const metrics::ConnectivityScores& s) {
  return {s.accuracy, s.precision, s.recall, s.bones, s.tree_edit_distance, s.likeliest_root, s.root};
}

// The weights of `from` in the joints of `to`, found by name; empty where one of them is missing.
std::optional<SkinWeights> renumbered(const SkinWeights& weights, const Skeleton& from, const Skeleton& to) {
  std::map<std::string, JointId> by_name;
  for (JointId j : to.names.ids()) by_name[to.names[j]] = j;
  SkinWeights out;
  std::vector<Influence> row;
  for (VertexId v : ids<VertexId>(weights.size())) {
    row.clear();
    for (const Influence& i : weights[v]) {
      const auto found = by_name.find(from.names[i.joint]);
      if (found == by_name.end()) return std::nullopt;
      row.push_back({found->second, i.weight});
    }
    out.append(row);
  }
  return out;
}

using Tables = std::vector<metrics::ScoreTable>;

Tables compare_files(const EvaluateArguments& arguments) {
  const Rig predicted = load_rig(arguments.predicted);
  const Rig expected = load_rig(arguments.reference);
  const Reference reference = naming(arguments.reference, [&] { return Reference(expected); });
  const std::string id = arguments.predicted.stem().string();
  Tables tables{{"skeleton", kSkeletonColumns, {{id, "file", values(reference.skeleton_scores(predicted.skeleton))}}, {}},
                {"skin", kSkinColumns, {}, {}}};
  const bool same_mesh = predicted.mesh.positions.size() == reference.rig.mesh.positions.size();
  const auto weights = same_mesh ? renumbered(predicted.weights, predicted.skeleton, reference.rig.skeleton) : std::nullopt;
  if (weights)
    tables[1].rows.push_back({id, "file", values(reference.skin_scores(*weights))});
  else
    tables[1].failures.push_back(id + (same_mesh ? ": weights cannot be compared: the joints have other names"
                                                 : ": weights cannot be compared: the meshes have different vertices"));
  return tables;
}

// What became of one character in one task: a row, or the reason why there is none.
struct Outcome {
  std::vector<double> values;
  std::string failure;
};

template <class Work>
Outcome attempt(Work&& work) {
  try {
    return {work(), {}};
  } catch (const std::exception& e) {
    return {{}, e.what()};
  }
}

// How the system is shown the characters: turned by right angles (exactly, without rounding) and scaled.
struct Showing {
  Eigen::Matrix3f turn;
  float scale;

  explicit Showing(const EvaluateArguments& arguments) : turn(Eigen::Matrix3f::Identity()), scale(arguments.scale) {
    Eigen::Matrix3f about_y, to_z, to_x;
    about_y << 0, 0, 1, 0, 1, 0, -1, 0, 0;
    to_z << 1, 0, 0, 0, 0, -1, 0, 1, 0;
    to_x << 0, 1, 0, -1, 0, 0, 0, 0, 1;
    for (int i = 0; i < arguments.turn; ++i) turn = about_y * turn;
    if (arguments.up == io::UpAxis::z) turn = to_z * turn;
    if (arguments.up == io::UpAxis::x) turn = to_x * turn;
  }
  TriangleMesh mesh(TriangleMesh mesh) const {
    for (Vec3f& p : mesh.positions) p = scale * (turn * p);
    return mesh;
  }
  Skeleton skeleton(Skeleton skeleton) const {
    skeleton = turned(std::move(skeleton), turn);
    for (Vec3f& p : skeleton.rest_positions) p *= scale;
    return skeleton;
  }
  Skeleton undo(Skeleton skeleton) const {
    for (Vec3f& p : skeleton.rest_positions) p /= scale;
    return turned(std::move(skeleton), turn.transpose());
  }
};

enum class Task { skeleton, skin, connectivity };
constexpr std::array kTasks{"skeleton", "skin", "connectivity"};

bool wanted(std::size_t task, const EvaluateArguments& arguments) { return arguments.task == "all" || arguments.task == kTasks[task]; }

// For the skeleton the system sees the bare mesh; for the others it also gets the reference's skeleton, or its joints.
std::vector<double> score(Task task, const Subject& subject, const infer::RignetModels& models, const EvaluateArguments& arguments) {
  const Showing showing(arguments);
  const TriangleMesh mesh = showing.mesh(subject.rig.mesh);
  pipelines::RignetOptions options = arguments.options;
  switch (task) {
    case Task::skeleton:
      return values(subject.reference.skeleton_scores(showing.undo(pipelines::rig_character(mesh, models, options).skeleton)));
    case Task::skin:
      options.skeleton = showing.skeleton(subject.rig.skeleton);
      return values(subject.reference.skin_scores(pipelines::rig_character(mesh, models, options).weights));
    case Task::connectivity:
      return values(connectivity_scores({mesh, showing.skeleton(subject.rig.skeleton), subject.rig.weights}, models, options));
  }
  return {};
}

Tables evaluate_split(const EvaluateArguments& arguments) {
  const auto models = arguments.models.load();
  if (arguments.task == "skin-methods") return {skin_methods_table(arguments.data, arguments.split, models, kSkinColumns)};
  Tables tables{{"skeleton", kSkeletonColumns, {}, {}},
                {"skin, skeleton given", kSkinColumns, {}, {}},
                {"connectivity, joints given", kConnectivityColumns, {}, {}}};
  struct Result {
    dataset::CharacterInfo info;
    std::array<Outcome, kTasks.size()> outcomes;
  };
  std::vector<Result> results;
  const auto unread = for_each_character(
      arguments.data, arguments.split, [&](std::size_t count) { results.resize(count); },
      [&](std::size_t i, const Subject& subject) {
        results[i].info = subject.info;
        for (std::size_t t = 0; t < kTasks.size(); ++t)
          if (wanted(t, arguments))
            results[i].outcomes[t] = attempt([&] { return score(static_cast<Task>(t), subject, models, arguments); });
      });
  for (std::size_t t = 0; t < kTasks.size(); ++t) {
    if (!wanted(t, arguments)) continue;
    tables[t].failures = unread;
    for (const auto& [info, outcomes] : results) {
      if (!outcomes[t].failure.empty()) tables[t].failures.push_back(info.id + ": " + outcomes[t].failure);
      if (!outcomes[t].values.empty()) tables[t].rows.push_back({info.id, info.category, outcomes[t].values});
    }
  }
  std::erase_if(tables, [](const metrics::ScoreTable& table) { return table.rows.empty() && table.failures.empty(); });
  return tables;
}

void write_json(const std::filesystem::path& path, const Tables& tables) {
  nlohmann::json out = nlohmann::json::array();
  for (const metrics::ScoreTable& table : tables) out.push_back(metrics::to_json(table));
  std::ofstream file(path);
  file << out.dump(2) << '\n';
  file.close();
  if (!file) throw Error("{}: cannot be written", path.string());
}

// What a study leaves out, by name.
const std::map<std::string, std::function<void(pipelines::RignetOptions&)>> kParts{{"attention", [](auto& o) { o.ablation.attention = false; }},
                                                                                   {"views", [](auto& o) { o.ablation.views = false; }},
                                                                                   {"spread", [](auto& o) { o.extraction.spread_share = 2.0f; }},
                                                                                   {"symmetry", [](auto& o) { o.symmetry = pipelines::Symmetry::off; }},
                                                                                   {"fingers", [](auto& o) { o.fingers = pipelines::Fingers::off; }},
                                                                                   {"edge-loops", [](auto& o) { o.ablation.edge_loops = false; }},
                                                                                   {"bone-network", [](auto& o) { o.ablation.bone_network = false; }},
                                                                                   {"geodesic", [](auto& o) { o.ablation.geodesic = false; }},
                                                                                   {"neuroskinning", [](auto& o) { o.ablation.neuroskinning = 0.0f; }},
                                                                                   {"islands", [](auto& o) { o.skin.rigid_islands = false; }}};

void measure(const EvaluateArguments& arguments) {
  const Tables tables = arguments.data.empty() ? compare_files(arguments) : evaluate_split(arguments);
  for (const metrics::ScoreTable& table : tables) fmt::print("{}\n", metrics::to_text(table));
  if (!arguments.json.empty()) write_json(arguments.json, tables);
  if (std::ranges::all_of(tables, [](const metrics::ScoreTable& table) { return table.rows.empty(); }))
    throw Error("evaluate: nothing could be measured");
}

void check(const EvaluateArguments& arguments) {
  if (arguments.data.empty() == arguments.predicted.empty()) throw Error("evaluate needs either two files or --data");
  std::vector<std::filesystem::path> inputs;
  if (arguments.data.empty()) inputs = {arguments.predicted, arguments.reference};
  std::vector<Output> outputs;
  if (!arguments.json.empty()) outputs.push_back({"--json", arguments.json, ".json"});
  if (!arguments.gallery.empty()) outputs.push_back({"--gallery", arguments.gallery, ".png"});
  check_outputs(inputs, outputs);
}

void evaluate(EvaluateArguments arguments) {
  check(arguments);
  for (const std::string& part : arguments.without) kParts.at(part)(arguments.options);
  const std::filesystem::path& data = arguments.data;
  const std::string& split = arguments.split;
  const pipelines::RignetOptions& options = arguments.options;
  if (!arguments.gallery.empty())
    fmt::print("{}", save_gallery(arguments.gallery, data, split, arguments.models.load(), options));
  else if (!arguments.plots.empty())
    save_evaluation_plots(arguments.plots, data, split, arguments.models.load());
  else if (!arguments.calibration.empty())
    fmt::print("{}", save_calibration(arguments.calibration, data, split, arguments.models.load(), options));
  else
    measure(arguments);
}

void add_pictures(CLI::App& command, EvaluateArguments& arguments, CLI::Option* data, CLI::Option* json) {
  auto* gallery =
      command.add_option("--gallery", arguments.gallery, "Instead: draw the worst ten skeletons beside what they should be (PNG)");
  auto* plots = command.add_option("--plots", arguments.plots, "Instead: draw how the measures follow the options, into this folder (SVG)");
  auto* calibration = command.add_option("--calibration", arguments.calibration,
                                         "Instead: measure the confidence, and fit it anew, into this folder (JSON, SVG, C++)");
  gallery->type_name("FILE")->needs(data)->excludes(plots)->excludes(calibration);
  plots->type_name("FOLDER")->check(CLI::ExistingDirectory)->needs(data)->excludes(calibration);
  calibration->type_name("FOLDER")->check(CLI::ExistingDirectory)->needs(data);
  for (CLI::Option* instead : {gallery, plots, calibration}) instead->excludes(json);
}

// What does not matter for use, but for finding out what is good for what.
void add_study_options(CLI::App& command, EvaluateArguments& arguments) {
  pipelines::RignetOptions& options = arguments.options;
  std::vector<CLI::Option*> list{
      command.add_option("--bandwidth", options.bandwidth, "Of the mean shift: larger gives fewer joints"),
      command.add_option("--min-share", options.extraction.min_share, "Least share of the attention that makes a joint")
          ->capture_default_str(),
      command.add_option("--spread-share", options.extraction.spread_share, "The same for joints whose votes are spread")
          ->capture_default_str(),
      command.add_option("--prune", options.skin.prune_share, "Weights below this share of a vertex's largest go"),
      command.add_option("--max-influences", options.skin.max_influences, "Joints that may move a vertex")->capture_default_str(),
      command.add_option("--bones", options.ablation.bones, "Nearest bones that a vertex chooses from")->capture_default_str(),
      command.add_option("--without", arguments.without, "Leave out parts of the method, separated by commas")
          ->delimiter(',')
          ->check(CLI::IsMember(kParts))};
  for (CLI::Option* option : list) option->group("Studies");
}

}  // namespace

void add_evaluate_command(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("evaluate", "Measure a rig against a reference, or Osteon against the characters of a data folder");
  auto arguments = std::make_shared<EvaluateArguments>();
  CLI::Option* predicted = command->add_option("predicted", arguments->predicted, "A rigged character");
  CLI::Option* reference = command->add_option("reference", arguments->reference, "The same character with the rig that it should have");
  predicted->needs(reference);
  CLI::Option* data = command->add_option("--data", arguments->data, "Folder with manifest.jsonl: rig its characters anew and compare")
                          ->excludes(predicted);
  command->add_option("--split", arguments->split, "Which split of the manifest")->capture_default_str();
  command
      ->add_option("--task", arguments->task,
                   "What to measure: the skeleton from the bare mesh, the skin for the reference's skeleton, the bones between its joints; "
                   "skin-methods: the skin by every method")
      ->check(CLI::IsMember({"skeleton", "skin", "connectivity", "skin-methods", "all"}))
      ->capture_default_str();
  command
      ->add_option_function<int>(
          "--turn", [arguments](int degrees) { arguments->turn = degrees / 90; }, "Show every character turned about the up axis")
      ->check(CLI::IsMember({0, 90, 180, 270}));
  add_choice(*command, "--up", arguments->up, {{"x", io::UpAxis::x}, {"y", io::UpAxis::y}, {"z", io::UpAxis::z}},
             "Show every character with this axis up");
  command->add_option("--scale", arguments->scale, "Show every character so much larger")->check(above_zero())->capture_default_str();
  arguments->models.add_to(*command);
  command->add_option("--detail", arguments->options.detail, "How many joints to find: 0 few .. 1 many")->capture_default_str();
  CLI::Option* json =
      command->add_option("--json", arguments->json, "Also write the table, with every character's values, to this file (JSON)");
  add_pictures(*command, *arguments, data, json);
  add_study_options(*command, *arguments);
  command->callback([arguments] { evaluate(*arguments); });
}

}  // namespace osteon::app
