// SPDX-License-Identifier: Apache-2.0
#include "rig_report.h"

#include <fstream>
#include <nlohmann/json.hpp>

#include "osteon/base/error.h"

namespace osteon::app {
namespace {

using Json = nlohmann::ordered_json;

Json number(const std::optional<float>& value) { return value ? Json(*value) : Json(nullptr); }

Json to_json(const pipelines::RigReport& report) {
  Json stages = Json::array();
  for (const auto& [stage, seconds] : report.stages) stages.push_back({{"stage", stage}, {"seconds", seconds}});
  return {{"vertices", report.vertices},
          {"working_vertices", report.working_vertices},
          {"joints", report.joints},
          {"confidence", report.confidence},
          {"character", number(report.character)},
          {"joint_confidence", report.joint_confidence},
          {"explained", number(report.explained)},
          {"bone_confidence", number(report.bone_confidence)},
          {"coverage", report.coverage},
          {"symmetry_error", number(report.symmetry_error)},
          {"bandwidth", number(report.bandwidth)},
          {"stages", stages},
          {"warnings", report.warnings},
          {"repairs", report.repairs}};
}

}  // namespace

void save_report(const std::filesystem::path& path, const pipelines::RigReport& report, const std::filesystem::path& input) {
  Json json{{"osteon", OSTEON_VERSION}, {"input", input.string()}};
  json.update(to_json(report));
  std::ofstream file(path);
  // Names from the input may not be UTF-8.
  file << json.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
  file.close();
  if (!file) throw Error("{}: cannot write the report", path.string());
}

}  // namespace osteon::app
