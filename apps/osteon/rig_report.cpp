// SPDX-License-Identifier: Apache-2.0
#include "rig_report.h"

#include <array>
#include <nlohmann/json.hpp>

#include "osteon/io/bytes.h"

namespace osteon::app {
namespace {

using Json = nlohmann::ordered_json;

Json number(const std::optional<float>& value) { return value ? Json(*value) : Json(nullptr); }

}  // namespace

Json to_json(const pipelines::RigReport& report, const std::vector<std::string>& changes) {
  Json stages = Json::array();
  for (const auto& [stage, seconds] : report.stages) stages.push_back({{"stage", stage}, {"seconds", seconds}});
  return {{"vertices", report.vertices},
          {"working_vertices", report.working_vertices},
          {"joints", report.joints},
          {"up", std::string(1, report.up)},
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
          {"repairs", report.repairs},
          {"changes", changes}};
}

void save_json(const std::filesystem::path& path, const Json& json) {
  const std::string text = json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
  const std::span<const std::uint8_t> bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  io::write_file(path, std::array{bytes});
}

}  // namespace osteon::app
