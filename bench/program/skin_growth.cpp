// SPDX-License-Identifier: Apache-2.0
// skin_growth FOLDER: how the time of binding a mesh to a skeleton grows with its vertices and its bones, method by method. Prints the
// table of docs/performance.md and writes its diagrams, skin_vertices.svg and skin_bones.svg, into FOLDER. Three runs each, the median;
// networks are loaded before.
#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <vector>

#include "osteon/base/error.h"
#include "osteon/metrics/line_plot.h"
#include "osteon/pipelines/skin_character.h"
#include "osteon/synth/character.h"
#include "skin/cut_bones.h"

namespace osteon {
namespace {

namespace fs = std::filesystem;

constexpr std::array kCells{36, 72, 144, 288, 576};  // of the generator's grid: vertices grow with their square
constexpr int kPlainCells = 72;
constexpr std::array kParts{1, 2, 4, 8};  // that every bone is cut into
constexpr int kRuns = 3;

Rig biped(int cells) { return synth::make_character(synth::Kind::Biped, 3, {cells, synth::Finish::Smooth}); }

struct NamedMethod {
  explicit NamedMethod(const char* n) : name(n) {}

  const char* name;
  pipelines::SkinCharacterOptions options = {};
};

double seconds_of(const TriangleMesh& mesh, const Skeleton& skeleton, const pipelines::SkinCharacterOptions& options) {
  std::array<double, kRuns> seconds;
  for (double& s : seconds) {
    const auto start = std::chrono::steady_clock::now();
    pipelines::skin_character(mesh, skeleton, options);
    s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }
  std::ranges::sort(seconds);
  return seconds[kRuns / 2];
}

// One row of the table, and a point of each method's line.
void measure(const Rig& rig, const Skeleton& skeleton, const std::vector<NamedMethod>& methods, double x,
             std::vector<metrics::PlotLine>& lines) {
  fmt::print("| {} | {} |", rig.mesh.positions.size(), skeleton.size());
  for (std::size_t m = 0; m < methods.size(); ++m) {
    const double seconds = seconds_of(rig.mesh, skeleton, methods[m].options);
    lines[m].points.emplace_back(x, seconds);
    fmt::print(" {:.2f} |", seconds);
    std::fflush(stdout);
  }
  fmt::print("\n");
}

void run(const fs::path& folder) {
  const infer::RignetModels rignet = infer::RignetModels::load();
  const infer::NeuroskinningModel neuroskinning = infer::NeuroskinningModel::load();
  std::vector<NamedMethod> methods;
  for (const auto& [name, method] : {std::pair{"geovoxel", skin::Method::geovoxel},
                                     {"heat", skin::Method::heat},
                                     {"biharmonic", skin::Method::biharmonic},
                                     {"rigid", skin::Method::rigid}})
    methods.emplace_back(name).options.bind.method = method;
  methods.emplace_back("rignet").options.rignet = &rignet;
  methods.emplace_back("neuroskinning").options.neuroskinning = &neuroskinning;

  std::vector<metrics::PlotLine> lines;
  fmt::print("| vertices | joints |");
  for (const NamedMethod& method : methods) {
    lines.push_back({method.name, {}});
    fmt::print(" {}, s |", method.name);
  }
  fmt::print("\n|---|---|");
  for (std::size_t m = 0; m < methods.size(); ++m) fmt::print("---|");
  fmt::print("\n");
  std::vector<metrics::PlotLine> by_bones = lines;
  for (const int cells : kCells) {
    const Rig rig = biped(cells);
    measure(rig, rig.skeleton, methods, 1e-3 * static_cast<double>(rig.mesh.positions.size()), lines);
  }
  const Rig plain = biped(kPlainCells);
  for (const int parts : kParts) {
    const Skeleton skeleton = bench::with_bones_cut(plain.skeleton, parts);
    measure(plain, skeleton, methods, static_cast<double>(skeleton.size()), by_bones);
  }
  metrics::save_svg(folder / "skin_vertices.svg", {"osteon skin, two cores", {"thousand vertices", 0.0}, {"seconds", 0.0}, lines});
  metrics::save_svg(folder / "skin_bones.svg", {"osteon skin, two cores", {"joints", 0.0}, {"seconds", 0.0}, by_bones});
}

}  // namespace
}  // namespace osteon

int main(int argc, char** argv) {
  if (argc != 2) {
    fmt::print(stderr, "usage: skin_growth FOLDER\n");
    return 2;
  }
  try {
    osteon::run(argv[1]);
  } catch (const osteon::Error& e) {
    fmt::print(stderr, "error: {}\n", e.what());
    return 1;
  }
}
