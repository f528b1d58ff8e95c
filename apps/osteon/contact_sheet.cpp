// SPDX-License-Identifier: Apache-2.0
#include "contact_sheet.h"

#include <algorithm>

#include "osteon/render/figure.h"
#include "osteon/render/palette.h"

namespace osteon::app {
namespace {

constexpr float kMargin = 0.06f;  // beside the character, tiles
const render::View kView{.yaw = -0.7f, .pitch = 0.2f};

render::Image picture_of(const Rig& rig, int tile) {
  const auto joint_colors = render::joint_colors(rig.skeleton.size());
  const auto colors = render::weight_colors(rig.weights, joint_colors);
  const auto skeleton =
      render::skeleton_shape(rig.skeleton, rig.skeleton.rest_positions, joint_colors, 0.012f * bounds(rig.mesh).diagonal().norm());
  const auto side = static_cast<float>(tile);
  const Eigen::Matrix3f axes = render::view_axes(kView);
  const Eigen::AlignedBox3f seen = render::seen_bounds(rig.mesh.positions, kView);
  const float scale = (1.0f - 2.0f * kMargin) * side / std::max(seen.sizes().x(), seen.sizes().y());
  return render::draw({rig.mesh, colors, &skeleton}, {axes, axes.transpose() * seen.center(), {0.5f * side, 0.5f * side}, scale}, tile,
                      tile);
}

}  // namespace

render::Image contact_sheet(const std::vector<Rig>& rigs, const ContactSheetOptions& options) {
  const int count = static_cast<int>(rigs.size()), columns = std::clamp(count, 1, options.columns);
  render::Image sheet(columns * options.tile, (count + columns - 1) / columns * options.tile);
  for (int i = 0; i < count; ++i)
    render::paste(sheet, picture_of(rigs[static_cast<std::size_t>(i)], options.tile), i % columns * options.tile,
                  i / columns * options.tile);
  return sheet;
}

}  // namespace osteon::app
