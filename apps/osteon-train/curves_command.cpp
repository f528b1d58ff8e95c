// SPDX-License-Identifier: Apache-2.0
#include "curves_command.h"

#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "../outputs.h"
#include "osteon/base/error.h"
#include "osteon/metrics/line_plot.h"

namespace osteon::app {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostPoints = 40;  // of a line: neighbours are put together until there are so few

struct Arguments {
  std::vector<fs::path> logs;
  fs::path out;
  std::string figure = "loss", kind = "validation", title;
};

// The figure against the step, as logged.
std::vector<std::pair<double, double>> points_of(const fs::path& log, const Arguments& a) {
  std::ifstream file(log);
  if (!file) throw Error("{}: cannot be read", log.string());
  std::vector<std::pair<double, double>> points;
  std::string text;
  for (std::size_t number = 1; std::getline(file, text); ++number) {
    const auto line = nlohmann::json::parse(text, nullptr, false);
    const auto is_figure = [](const nlohmann::json& value) { return value.is_number() || value.is_null(); };  // null: it was not finite
    if (!line.is_object() || !line.contains("kind") || !line.value("step", nlohmann::json()).is_number() ||
        !is_figure(line.value(a.figure, nlohmann::json())))
      throw Error("{}: line {}: expected what `--log` writes", log.string(), number);
    if (line["kind"] == a.kind && line.contains(a.figure) && !line[a.figure].is_null())
      points.emplace_back(line["step"].get<double>(), line[a.figure].get<double>());
  }
  if (points.empty()) throw Error("{}: no {} figure `{}`", log.string(), a.kind, a.figure);
  return points;
}

std::vector<std::pair<double, double>> thinned(const std::vector<std::pair<double, double>>& points) {
  const std::size_t each = (points.size() + kMostPoints - 1) / kMostPoints;
  std::vector<std::pair<double, double>> out;
  for (std::size_t first = 0; first < points.size(); first += each) {
    const std::size_t last = std::min(first + each, points.size());
    double x = 0.0, y = 0.0;
    for (std::size_t i = first; i < last; ++i) {
      x += points[i].first;
      y += points[i].second;
    }
    out.emplace_back(x / static_cast<double>(last - first), y / static_cast<double>(last - first));
  }
  return out;
}

void draw(const Arguments& a) {
  check_outputs(a.logs, {{"-o", a.out, ".svg"}});
  std::vector<metrics::PlotLine> lines;
  for (const fs::path& log : a.logs) lines.push_back({log.stem().string(), thinned(points_of(log, a))});
  metrics::save_svg(a.out, {a.title, {"steps", 0.0}, {a.kind + ' ' + a.figure}, lines});
}

}  // namespace

void add_curves_command(CLI::App& app) {
  auto* command = app.add_subcommand("curves", "Draws logs of training: a figure against the steps, a line for each log");
  auto a = std::make_shared<Arguments>();
  command->add_option("logs", a->logs, "What --log wrote")->required()->check(CLI::ExistingFile)->expected(1, 6);
  command->add_option("-o,--out", a->out, "The diagram (SVG)")->required();
  command->add_option("--figure", a->figure, "Which figure: loss, or another that the log has")->capture_default_str();
  command->add_option("--kind", a->kind)->check(CLI::IsMember({"training", "validation"}))->capture_default_str();
  command->add_option("--title", a->title);
  command->callback([a] { draw(*a); });
}

}  // namespace osteon::app
