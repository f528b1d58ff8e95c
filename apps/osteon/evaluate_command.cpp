// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <fstream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "commands.h"
#include "load_options.h"
#include "model_options.h"
#include "osteon/base/parallel.h"
#include "osteon/dataset/manifest.h"
#include "osteon/geometry/joint_rays.h"
#include "osteon/geometry/working_mesh.h"
#include "osteon/metrics/score_table.h"
#include "osteon/metrics/skeleton_metrics.h"
#include "osteon/metrics/skin_metrics.h"
#include "osteon/pipelines/rignet.h"
#include "progress_line.h"
#include "rigged_file.h"

namespace osteon::app {
namespace {

struct EvaluateArguments {
  std::filesystem::path predicted, reference, data, json;
  ModelOptions models;
  std::string split = "val", task = "all";
  int turn = 0;  // quarter turns
  io::UpAxis up = io::UpAxis::y;
  float scale = 1.0f;
  pipelines::RignetOptions options;
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

std::vector<double> values(const metrics::SkeletonScores& s) {
  return {s.iou, s.precision, s.recall, s.cd_j2j, s.cd_j2b, s.cd_b2b, s.tree_edit_distance};
}
std::vector<double> values(const metrics::SkinScores& s) { return {s.precision, s.recall, s.l1, s.mean_distance, s.max_distance}; }

void normalise(Skeleton& skeleton, const geometry::Normalization& normalization) {
  for (Vec3f& p : skeleton.rest_positions) p = normalization.apply(p);
}

// A reference character in the frame of the measures: longest side 1.
struct Reference {
  Rig rig;
  geometry::Normalization normalization;
  PerJoint<float> tolerances;

  explicit Reference(Rig loaded) : rig(std::move(loaded)), normalization(geometry::normalization_of(rig.mesh)) {
    for (Vec3f& p : rig.mesh.positions) p = normalization.apply(p);
    normalise(rig.skeleton, normalization);
    std::vector<int> parents;
    for (const auto& parent : rig.skeleton.parents) parents.push_back(parent ? static_cast<int>(*parent) : -1);
    tolerances = PerJoint<float>(geometry::joint_tolerances(rig.mesh, rig.skeleton.rest_positions.raw(), parents));
  }

  // `predicted` is in world space of the file that the reference came from.
  std::vector<double> skeleton_scores(Skeleton predicted) const {
    normalise(predicted, normalization);
    return values(metrics::compare_skeletons(predicted, rig.skeleton, tolerances));
  }
  std::vector<double> skin_scores(const SkinWeights& predicted) const { return values(metrics::compare_weights(rig, predicted)); }
};

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
  const Reference reference(load_rig(arguments.reference));
  const std::string id = arguments.predicted.stem().string();
  Tables tables{{"skeleton", kSkeletonColumns, {{id, "file", reference.skeleton_scores(predicted.skeleton)}}, {}},
                {"skin", kSkinColumns, {}, {}}};
  const bool same_mesh = predicted.mesh.positions.size() == reference.rig.mesh.positions.size();
  const auto weights = same_mesh ? renumbered(predicted.weights, predicted.skeleton, reference.rig.skeleton) : std::nullopt;
  if (weights)
    tables[1].rows.push_back({id, "file", reference.skin_scores(*weights)});
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

// The system sees the bare mesh; for the skin it also gets the reference skeleton, as in RigNet's table 2.
std::vector<double> score_skeleton(const Rig& original, const Reference& reference, const infer::RignetModels& models,
                                   const EvaluateArguments& arguments) {
  const Showing showing(arguments);
  const auto result = pipelines::rig_character(showing.mesh(original.mesh), models, arguments.options);
  return reference.skeleton_scores(showing.undo(result.skeleton));
}

std::vector<double> score_skin(const Rig& original, const Reference& reference, const infer::RignetModels& models,
                               const EvaluateArguments& arguments) {
  const Showing showing(arguments);
  pipelines::RignetOptions options = arguments.options;
  options.skeleton = showing.skeleton(original.skeleton);
  return reference.skin_scores(pipelines::rig_character(showing.mesh(original.mesh), models, options).weights);
}

using Outcomes = std::array<Outcome, 2>;  // skeleton, skin

// One bad character does not stop the others.
Outcomes evaluate_character(const dataset::ManifestEntry& entry, const EvaluateArguments& arguments, const infer::RignetModels& models) {
  try {
    const Rig rig = load_rig(entry.file);
    const Reference reference(rig);
    Outcomes out;
    if (arguments.task != "skin") out[0] = attempt([&] { return score_skeleton(rig, reference, models, arguments); });
    if (arguments.task != "skeleton") out[1] = attempt([&] { return score_skin(rig, reference, models, arguments); });
    return out;
  } catch (const Error& e) {
    return {Outcome{{}, e.what()}, Outcome{{}, e.what()}};
  }
}

Tables evaluate_split(const EvaluateArguments& arguments) {
  const auto models = arguments.models.load();
  const auto entries = dataset::read_manifest(arguments.data, arguments.split);
  std::vector<Outcomes> outcomes(entries.size());
  ProgressLine progress("evaluating " + arguments.split, entries.size());
  parallel_for(entries.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      outcomes[i] = evaluate_character(entries[i], arguments, models);
      progress.advance();
    }
  });

  Tables tables{{"skeleton", kSkeletonColumns, {}, {}}, {"skin, skeleton given", kSkinColumns, {}, {}}};
  for (std::size_t i = 0; i < entries.size(); ++i)
    for (std::size_t t = 0; t < tables.size(); ++t) {
      const auto& [id, group, category] = entries[i].info;
      const Outcome& outcome = outcomes[i][t];
      if (!outcome.failure.empty()) tables[t].failures.push_back(id + ": " + outcome.failure);
      if (!outcome.values.empty()) tables[t].rows.push_back({id, category, outcome.values});
    }
  std::erase_if(tables, [](const metrics::ScoreTable& table) { return table.rows.empty() && table.failures.empty(); });
  return tables;
}

void write_json(const std::filesystem::path& path, const Tables& tables) {
  nlohmann::json out = nlohmann::json::array();
  for (const metrics::ScoreTable& table : tables) out.push_back(metrics::to_json(table));
  std::ofstream file(path);
  file << out.dump(2) << '\n';
  if (!file) throw Error("{}: cannot be written", path.string());
}

void evaluate(const EvaluateArguments& arguments) {
  if (arguments.data.empty() == arguments.predicted.empty()) throw Error("evaluate needs either two files or --data");
  const Tables tables = arguments.data.empty() ? compare_files(arguments) : evaluate_split(arguments);
  for (const metrics::ScoreTable& table : tables) fmt::print("{}\n", metrics::to_text(table));
  if (!arguments.json.empty()) write_json(arguments.json, tables);
}

}  // namespace

void add_evaluate_command(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("evaluate", "Measure a rig against a reference, or Osteon against the characters of a data folder");
  auto arguments = std::make_shared<EvaluateArguments>();
  CLI::Option* predicted = command->add_option("predicted", arguments->predicted, "A rigged character");
  CLI::Option* reference = command->add_option("reference", arguments->reference, "The same character with the rig that it should have");
  predicted->needs(reference);
  command->add_option("--data", arguments->data, "Folder with manifest.jsonl: rig its characters anew and compare")->excludes(predicted);
  command->add_option("--split", arguments->split, "Which split of the manifest")->capture_default_str();
  command->add_option("--task", arguments->task, "What to measure")
      ->check(CLI::IsMember({"skeleton", "skin", "all"}))
      ->capture_default_str();
  command
      ->add_option_function<int>(
          "--turn", [arguments](int degrees) { arguments->turn = degrees / 90; }, "Show every character turned about the up axis")
      ->check(CLI::IsMember({0, 90, 180, 270}));
  command->add_option("--up", arguments->up, "Show every character with this axis up")
      ->transform(CLI::CheckedTransformer(up_axes()))
      ->type_name("x|y|z")
      ->default_str("y");
  command->add_option("--scale", arguments->scale, "Show every character so much larger")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  arguments->models.add_to(*command);
  pipelines::RignetOptions& options = arguments->options;
  command->add_option("--bandwidth", options.bandwidth, "Of the mean shift: larger gives fewer joints");
  command->add_option("--min-share", options.extraction.min_share, "Least share of the attention that makes a joint")
      ->capture_default_str();
  command->add_option("--spread-share", options.extraction.spread_share, "The same for joints whose votes are spread")
      ->capture_default_str();
  command->add_option("--prune", options.skin.prune_share, "Weights below this share of a vertex's largest go")->capture_default_str();
  command->add_option("--json", arguments->json, "Also write the table, with every character's values, to this file");
  command->callback([arguments] { evaluate(*arguments); });
}

}  // namespace osteon::app
