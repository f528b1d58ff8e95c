// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <optional>

#include "../outputs.h"
#include "commands.h"
#include "naming.h"
#include "osteon/geometry/working_mesh.h"
#include "osteon/metrics/skin_metrics.h"
#include "osteon/pipelines/skin_quality.h"
#include "osteon/render/picture.h"
#include "osteon/skin/bind.h"
#include "osteon/skin/linear_blend.h"
#include "preview.h"
#include "rigged_file.h"
#include "skin_report.h"

namespace osteon::app {
namespace {

struct CompareArguments {
  std::filesystem::path a, b;
  std::optional<std::filesystem::path> json, picture;
};

// Longest side 1, as the measures have it.
Rig load_normalised(const std::filesystem::path& path, const std::vector<Output>& outputs) {
  Rig rig = load_rig(path, outputs);
  const geometry::Normalization frame = naming(path, [&] { return geometry::normalization_of(rig.mesh); });
  for (Vec3f& p : rig.mesh.positions) p = frame.apply(p);
  for (Vec3f& p : rig.skeleton.rest_positions) p = frame.apply(p);
  return rig;
}

// The weights of `from` in the joints of `to`.
SkinWeights renumbered(const Rig& from, const Skeleton& to) {
  const PerJoint<JointId> number = skin::joints_by_name(from.skeleton, to);
  SkinWeights out;
  for (VertexId v : from.mesh.positions.ids()) {
    std::vector<Influence> row(from.weights[v].begin(), from.weights[v].end());
    for (Influence& i : row) i.joint = number[i.joint];
    out.append(row);
  }
  return out;
}

void print_table(const CompareArguments& arguments, const pipelines::SkinQuality& a, const pipelines::SkinQuality& b,
                 const std::optional<metrics::SkinScores>& between) {
  const std::string name_a = arguments.a.stem().string(), name_b = arguments.b.stem().string();
  const std::size_t width_a = std::max<std::size_t>(12, name_a.size() + 2), width_b = std::max<std::size_t>(12, name_b.size() + 2);
  const auto print_line = [&](const char* name, double of_a, double of_b, int digits) {
    fmt::print("{:<34}{:>{}.{}f}{:>{}.{}f}\n", name, of_a, width_a, digits, of_b, width_b, digits);
  };
  fmt::print("{:<34}{:>{}}{:>{}}\n", "", name_a, width_a, name_b, width_b);
  print_line("vertices without weight", static_cast<double>(a.unweighted), static_cast<double>(b.unweighted), 0);
  print_line("coverage %", 100.0 * a.coverage, 100.0 * b.coverage, 1);
  print_line("leak %", 100.0 * a.leak, 100.0 * b.leak, 2);
  print_line("roughness", a.roughness, b.roughness, 4);
  if (a.asymmetry && b.asymmetry) print_line("asymmetry", *a.asymmetry, *b.asymmetry, 4);
  const skin::Deformation &da = a.deformation.mean, &db = b.deformation.mean;
  print_line("joints bent by 45 degrees: stretch", da.stretch, db.stretch, 4);
  print_line("  area", da.area, db.area, 4);
  print_line("  faces turned over %", 100.0 * da.flips, 100.0 * db.flips, 2);
  print_line("  volume lost %", 100.0 * da.volume_loss, 100.0 * db.volume_loss, 2);
  if (between)
    fmt::print("between them: L1 {:.3f}, mean distance {:.4f}, max distance {:.3f} (ten random poses, longest side 1)\n", between->l1,
               between->mean_distance, between->max_distance);
  else
    fmt::print("weights are not compared vertex by vertex: the meshes differ\n");
}

nlohmann::ordered_json json_of(const metrics::SkinScores& s) {
  return {
      {"precision", s.precision}, {"recall", s.recall}, {"l1", s.l1}, {"mean_distance", s.mean_distance}, {"max_distance", s.max_distance}};
}

// Each in a row: its weights from three sides, and the same pose.
render::Image picture_of(const Rig& rig) {
  const Pose pose = lively_pose(rig.skeleton, 1);
  const render::Posed posed{skin::skin(rig, pose), posed_positions(rig.skeleton, pose)};
  return render::character_picture({rig.mesh, &rig.skeleton, &rig.weights, &posed});
}

void save_picture(const std::filesystem::path& path, const Rig& a, const Rig& b) {
  const render::Image upper = picture_of(a), lower = picture_of(b);
  render::Image whole(upper.width, upper.height + lower.height);
  render::paste(whole, upper, 0, 0);
  render::paste(whole, lower, 0, upper.height);
  render::save_png(path, whole);
}

std::vector<Output> outputs_of(const CompareArguments& arguments) {
  std::vector<Output> outputs;
  if (arguments.json) outputs.push_back({"--json", *arguments.json, ".json"});
  if (arguments.picture) outputs.push_back({"--picture", *arguments.picture, ".png"});
  return outputs;
}

void compare(const CompareArguments& arguments) {
  const std::vector<Output> outputs = outputs_of(arguments);
  check_outputs({arguments.a, arguments.b}, outputs);
  const Rig a = load_normalised(arguments.a, outputs), b = load_normalised(arguments.b, outputs);
  const pipelines::SkinQuality of_a = pipelines::skin_quality(a), of_b = pipelines::skin_quality(b);
  std::optional<metrics::SkinScores> between;
  if (a.mesh.positions.size() == b.mesh.positions.size()) between = metrics::compare_weights(a, renumbered(b, a.skeleton));
  print_table(arguments, of_a, of_b, between);
  if (arguments.json)
    write_json(*arguments.json, {{"a", to_json(of_a, a.skeleton)},
                                 {"b", to_json(of_b, b.skeleton)},
                                 {"between", between ? json_of(*between) : nlohmann::ordered_json(nullptr)}});
  if (arguments.picture) save_picture(*arguments.picture, a, b);
}

}  // namespace

void add_compare_command(CLI::App& app) {
  CLI::App* command = app.add_subcommand("compare", "Two rigged characters side by side: weights and deformation");
  auto arguments = std::make_shared<CompareArguments>();
  command->add_option("a", arguments->a, "A rigged character")->required()->type_name("FILE");
  command->add_option("b", arguments->b, "Another one, or the same mesh with other weights")->required()->type_name("FILE");
  command->add_option("--json", arguments->json, "Also write the numbers to this file (JSON)")->type_name("FILE");
  command->add_option("--picture", arguments->picture, "Also draw both, the first above (PNG)")->type_name("FILE");
  command->callback([arguments] { compare(*arguments); });
}

}  // namespace osteon::app
