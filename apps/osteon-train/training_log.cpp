// SPDX-License-Identifier: Apache-2.0
#include "training_log.h"

#include <unistd.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <string>

#include "osteon/base/error.h"

namespace osteon::app {
namespace {

std::string text_of(const train::TrainReport& report) {
  std::string text = fmt::format("{:5.1f} %  step {}  {:.0f} s ", 100.0 * report.progress, report.step, report.seconds);
  if (report.is_validation) text += " validation:";
  for (const auto& [name, value] : report.figures) text += fmt::format("  {} {:.4g}", name, value);
  return text;
}

}  // namespace

TrainingLog::TrainingLog(const std::filesystem::path& file, Shown shown) : shown_(shown), terminal_(::isatty(STDERR_FILENO) != 0) {
  if (file.empty()) return;
  if (const int first = std::ifstream(file).peek(); first != std::char_traits<char>::eof() && first != '{')
    throw Error("{}: is there already and no log of training; choose another name", file.string());
  file_.open(file, std::ios::app);
  if (!file_) throw Error("{}: cannot be written", file.string());
}

void TrainingLog::operator()(const train::TrainReport& report) {
  const bool keep = report.is_validation || !terminal_;
  if (shown_ == Shown::here_and_in_file)
    std::fprintf(stderr, "%s%s%s", terminal_ ? "\r\033[K" : "", text_of(report).c_str(), keep ? "\n" : "");
  if (!file_.is_open()) return;
  nlohmann::ordered_json line{
      {"step", report.step}, {"seconds", report.seconds}, {"kind", report.is_validation ? "validation" : "training"}};
  for (const auto& [name, value] : report.figures) line[name] = value;
  if (!(file_ << line.dump() << std::endl)) {
    std::fprintf(stderr, "warning: the log cannot be written any more\n");
    file_.close();
  }
}

void print_profile(const train::StepProfile& profile) {
  const auto steps = static_cast<double>(std::max<std::int64_t>(profile.steps, 1));
  const auto row = [&](const char* what, double seconds) {
    std::fprintf(stderr, "%-44s %8.1f ms %6.1f %%\n", what, 1e3 * seconds / steps, 100.0 * seconds / std::max(profile.all(), 1e-9));
  };
  std::fprintf(stderr, "%lld steps, each\n", static_cast<long long>(profile.steps));
  row("waiting for the batch", profile.waiting);
  row("forward", profile.forward);
  row("backward", profile.backward);
  row("optimiser", profile.optimiser);
  row("whole step", profile.all());
  row("making a batch (sum over threads)", profile.making);
  row("matrix products (sum over threads)", profile.products);
  std::fprintf(stderr, "matrix products: %.2f GFLOP a step at %.0f GFLOP/s of a thread\n", 2e-9 * profile.multiplications / steps,
               2e-9 * profile.multiplications / std::max(profile.products, 1e-9));
}

}  // namespace osteon::app
