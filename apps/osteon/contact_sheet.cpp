// SPDX-License-Identifier: Apache-2.0
#include "contact_sheet.h"

#include <algorithm>

#include "osteon/render/figure.h"
#include "osteon/render/palette.h"

namespace osteon::app {
namespace {

constexpr float kMargin = 0.06f;  // beside the character, tiles
const render::View kView{.yaw = -0.7f, .pitch = 0.2f};

}  // namespace

render::Image tile_picture(const TriangleMesh& mesh, const PerVertex<Vec3f>& colors, const Skeleton& skeleton, const render::View& view,
                           int tile) {
  const auto shape = render::skeleton_shape(skeleton, skeleton.rest_positions, render::joint_colors(skeleton.size()),
                                            0.012f * bounds(mesh).diagonal().norm());
  const auto side = static_cast<float>(tile);
  const Eigen::Matrix3f axes = render::view_axes(view);
  const Eigen::AlignedBox3f seen = render::seen_bounds(mesh.positions, view);
  const float scale = (1.0f - 2.0f * kMargin) * side / std::max(seen.sizes().x(), seen.sizes().y());
  return render::draw({mesh, colors, &shape}, {axes, axes.transpose() * seen.center(), {0.5f * side, 0.5f * side}, scale}, tile, tile);
}

render::Image contact_sheet(const std::vector<Rig>& rigs, const ContactSheetOptions& options) {
  const int count = static_cast<int>(rigs.size()), columns = std::clamp(count, 1, options.columns);
  render::Image sheet(columns * options.tile, (count + columns - 1) / columns * options.tile);
  for (int i = 0; i < count; ++i) {
    const Rig& rig = rigs[static_cast<std::size_t>(i)];
    const auto colors = render::weight_colors(rig.weights, render::joint_colors(rig.skeleton.size()));
    render::paste(sheet, tile_picture(rig.mesh, colors, rig.skeleton, kView, options.tile), i % columns * options.tile,
                  i / columns * options.tile);
  }
  return sheet;
}

}  // namespace osteon::app
