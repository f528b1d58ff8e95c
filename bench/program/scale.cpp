// SPDX-License-Identifier: Apache-2.0
// scale OSTEON FOLDER: how time and memory of `osteon rig` grow with the mesh, and what a second core brings to `osteon batch`. Prints the
// tables of docs/performance.md and writes its diagrams, scale_time.svg and scale_memory.svg, into FOLDER. Three runs each, the median.
#include <fmt/core.h>
#include <fmt/ranges.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <vector>

#include "osteon/base/error.h"
#include "osteon/io/save.h"
#include "osteon/metrics/line_plot.h"
#include "osteon/synth/character.h"

namespace osteon {
namespace {

namespace fs = std::filesystem;

constexpr std::array kCells{24, 73, 230, 724, 1024, 1200};  // of the generator's grid: vertices grow with their square
constexpr int kRuns = 3;

struct Cost {
  double seconds, megabytes;
};

// Runs a program to its end. Throws Error if it fails.
Cost run(const std::vector<std::string>& command) {
  const auto start = std::chrono::steady_clock::now();
  std::fflush(stdout);  // or the child would print what waits there again
  const pid_t child = ::fork();
  if (child == 0) {
    std::vector<char*> words;
    for (const std::string& word : command) words.push_back(const_cast<char*>(word.c_str()));
    words.push_back(nullptr);
    ::freopen("/dev/null", "w", stdout);
    ::execv(words.front(), words.data());
    ::_exit(127);
  }
  int status = 0;
  rusage used{};
  ::wait4(child, &status, 0, &used);
  if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) throw Error("{}: failed", fmt::join(command, " "));
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return {seconds, static_cast<double>(used.ru_maxrss) / 1024.0};
}

Cost median_of(const std::vector<std::string>& command) {
  std::array<Cost, kRuns> costs;
  for (Cost& cost : costs) cost = run(command);
  std::ranges::sort(costs, {}, &Cost::seconds);
  return costs[kRuns / 2];
}

void scale(const std::string& program, const fs::path& work, const fs::path& folder) {
  metrics::PlotLine time{"rig", {}}, memory{"rig", {}};
  fmt::print("| vertices | triangles | wall, s | memory, MB |\n|---|---|---|---|\n");
  for (const int cells : kCells) {
    const TriangleMesh mesh = synth::make_character(synth::Kind::Biped, 3, {cells, synth::Finish::Smooth}).mesh;
    const fs::path input = work / "mesh.obj";
    io::save_obj(input, mesh);
    const Cost cost = median_of({program, "rig", input, "-o", work / "mesh.glb", "--quiet", "--min-confidence", "0"});
    const auto vertices = static_cast<double>(mesh.positions.size());
    fmt::print("| {} | {} | {:.2f} | {:.0f} |\n", mesh.positions.size(), mesh.faces.size(), cost.seconds, cost.megabytes);
    std::fflush(stdout);
    time.points.emplace_back(1e-6 * vertices, cost.seconds);
    memory.points.emplace_back(1e-6 * vertices, cost.megabytes);
  }
  metrics::save_svg(folder / "scale_time.svg", {"osteon rig, two cores", {"million vertices", 0.0}, {"seconds", 0.0}, {time}});
  metrics::save_svg(folder / "scale_memory.svg", {"osteon rig, two cores", {"million vertices", 0.0}, {"megabytes", 0.0}, {memory}});
}

void batch(const std::string& program, const fs::path& work) {
  constexpr int characters = 24;
  fs::create_directories(work / "in");
  for (int seed = 0; seed < characters; ++seed)
    io::save_obj(work / "in" / fmt::format("{}.obj", seed),
                 synth::make_character(synth::Kind::Biped, static_cast<std::uint64_t>(seed), {82, synth::Finish::Smooth}).mesh);
  const auto seconds = [&](const char* threads) {
    return median_of(
               {program, "batch", work / "in", "-o", work / "out", "--again", "--quiet", "--min-confidence", "0", "--threads", threads})
        .seconds;
  };
  const double one = seconds("1"), two = seconds("2");
  fmt::print(
      "\n| batch of {} characters | characters a second |\n|---|---|\n| one thread | {:.2f} |\n| two threads | {:.2f} ({:.2f} times) |\n",
      characters, characters / one, characters / two, one / two);
}

}  // namespace
}  // namespace osteon

int main(int argc, char** argv) {
  if (argc != 3) {
    fmt::print(stderr, "usage: scale OSTEON FOLDER\n");
    return 2;
  }
  const auto work = std::filesystem::temp_directory_path() / fmt::format("osteon-scale-{}", ::getpid());
  std::filesystem::create_directories(work);
  int code = 0;
  try {
    osteon::scale(argv[1], work, argv[2]);
    osteon::batch(argv[1], work);
  } catch (const osteon::Error& e) {
    fmt::print(stderr, "error: {}\n", e.what());
    code = 1;
  }
  std::filesystem::remove_all(work);
  return code;
}
