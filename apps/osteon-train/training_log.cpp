// SPDX-License-Identifier: Apache-2.0
#include "training_log.h"

#include <unistd.h>

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

TrainingLog::TrainingLog(const std::filesystem::path& file) : terminal_(::isatty(STDERR_FILENO) != 0) {
  if (file.empty()) return;
  file_.open(file, std::ios::app);
  if (!file_) throw Error("{}: cannot be written", file.string());
}

void TrainingLog::operator()(const train::TrainReport& report) {
  const bool keep = report.is_validation || !terminal_;
  std::fprintf(stderr, "%s%s%s", terminal_ ? "\r\033[K" : "", text_of(report).c_str(), keep ? "\n" : "");
  if (!file_.is_open()) return;
  nlohmann::ordered_json line{
      {"step", report.step}, {"seconds", report.seconds}, {"kind", report.is_validation ? "validation" : "training"}};
  for (const auto& [name, value] : report.figures) line[name] = value;
  file_ << line.dump() << std::endl;
}

}  // namespace osteon::app
