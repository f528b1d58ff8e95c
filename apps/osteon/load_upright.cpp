// SPDX-License-Identifier: Apache-2.0
#include "load_upright.h"

#include "osteon/geometry/stance.h"
#include "osteon/io/upright.h"

namespace osteon::app {

io::Asset load_upright(const std::filesystem::path& input, const io::LoadOptions& options) {
  io::Asset asset = io::load(input, options);
  const bool is_open = !options.up && asset.up == io::UpAxis::y;  // y is what is taken where a file says nothing
  if (is_open && geometry::stance(asset.mesh) == geometry::Stance::on_z && io::turn_upright(asset))
    asset.repairs.push_back("the character stands on the plane z = 0: turned upright, z to y (--up y leaves it as it is)");
  return asset;
}

void stand_up(io::Asset& asset, pipelines::RignetResult& result) {
  pipelines::RigReport& report = result.report;
  if (asset.up != io::UpAxis::y) {
    report.up = asset.up == io::UpAxis::x ? 'x' : 'z';
  } else if (report.up == 'z') {
    const bool is_turned = io::turn_upright(asset);
    if (is_turned) result.skeleton = turned(std::move(result.skeleton), io::turn_to_y_up(io::UpAxis::z));
    report.warnings.push_back(is_turned ? "turned upright, z to y (--up y leaves it as it is)"
                                        : "a glTF keeps its frame: what is written has z up, too (--up z turns it upright)");
  }
}

}  // namespace osteon::app
