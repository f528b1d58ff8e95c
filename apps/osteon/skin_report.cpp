// SPDX-License-Identifier: Apache-2.0
#include "skin_report.h"

#include <fstream>

#include "osteon/base/error.h"

namespace osteon::app {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kWorst = 5;  // joints that are named

Json to_json(const skin::Deformation& d) {
  return {{"stretch", d.stretch}, {"area", d.area}, {"flips", d.flips}, {"volume_loss", d.volume_loss}};
}

}  // namespace

Json to_json(const pipelines::SkinQuality& quality, const Skeleton& skeleton) {
  Json worst = Json::array();
  for (const auto& [joint, score] : quality.deformation.joints) {
    if (worst.size() == kWorst) break;
    Json one{{"joint", skeleton.names[joint]}};
    one.update(to_json(score));
    worst.push_back(std::move(one));
  }
  return {{"unweighted_vertices", quality.unweighted},
          {"largest_sum_error", quality.largest_sum_error},
          {"coverage", quality.coverage},
          {"leak", quality.leak},
          {"roughness", quality.roughness},
          {"asymmetry", quality.asymmetry ? Json(*quality.asymmetry) : Json(nullptr)},
          {"deformation", to_json(quality.deformation.mean)},
          {"worst_joints", worst}};
}

void write_json(const std::filesystem::path& path, const Json& json) {
  std::ofstream file(path);
  // Names from the input may not be UTF-8.
  file << json.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
  file.close();
  if (!file) throw Error("{}: cannot write the report", path.string());
}

}  // namespace osteon::app
