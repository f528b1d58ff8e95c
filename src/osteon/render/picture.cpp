// SPDX-License-Identifier: Apache-2.0
#include "osteon/render/picture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "osteon/render/figure.h"
#include "osteon/render/palette.h"

namespace osteon::render {
namespace {

constexpr float quarter_turn = 1.5707963f;
constexpr float pitch = 0.14f;  // a little from above, so that the ground is seen
const Vec3f clay(0.56f, 0.52f, 0.48f);

struct Panel {
  TriangleMesh mesh;
  PerVertex<Vec3f> colors;
  std::optional<ColoredMesh> overlay;
  View view;
  Vec3f foot = Vec3f::Zero();                       // below the middle of the mesh, on the ground: stands at one height in all panels
  Eigen::AlignedBox3f box = Eigen::AlignedBox3f();  // around the mesh, relative to the foot, in the axes of the view
};

PerVertex<Vec3f> surface_colors(const Character& character) {
  if (!character.skeleton || !character.weights) return PerVertex<Vec3f>(character.mesh.positions.size(), clay);
  auto colors = weight_colors(*character.weights, joint_colors(character.skeleton->size()));
  for (Vec3f& c : colors) c = 0.85f * c + 0.15f * Vec3f::Constant(0.6f);
  return colors;
}

Panel panel(const Character& character, const PerVertex<Vec3f>& positions, const PerJoint<Vec3f>& joints, const View& view) {
  Panel out{{positions, character.mesh.faces}, surface_colors(character), {}, view};
  const auto box = bounds(out.mesh);
  if (character.skeleton)
    out.overlay = skeleton_shape(*character.skeleton, joints, joint_colors(character.skeleton->size()), 0.011f * box.diagonal().norm());
  out.foot = {box.center().x(), box.min().y(), box.center().z()};
  out.box = seen_bounds(positions, view);
  out.box.translate(-(view_axes(view) * out.foot));
  return out;
}

std::vector<Panel> panels(const Character& character) {
  const auto joints = character.skeleton ? character.skeleton->rest_positions : PerJoint<Vec3f>();
  std::vector<Panel> out;
  for (const float yaw : {0.0f, -quarter_turn, -0.4f * quarter_turn})
    out.push_back(panel(character, character.mesh.positions, joints, {yaw, pitch}));
  if (character.posed) {
    out.push_back(panel(character, character.posed->vertices, character.posed->joints, {-0.4f * quarter_turn, pitch}));
    out.back().overlay.reset();
  }
  return out;
}

// Rows of panels at one scale.
struct Layout {
  std::size_t rows;
  float pixels_per_metre;
};

std::span<const Panel> row_of(const std::vector<Panel>& panels, std::size_t rows, std::size_t row) {
  const std::size_t columns = (panels.size() + rows - 1) / rows, first = std::min(panels.size(), row * columns);
  return std::span(panels).subspan(first, std::min(columns, panels.size() - first));
}

// Around all panels of a row as they stand side by side on one ground line, metres; x counts from 0.
Eigen::AlignedBox2f row_box(std::span<const Panel> row) {
  float width = 0, top = 0, bottom = 0;
  for (const Panel& p : row) {
    width += p.box.sizes().x();
    top = std::max(top, p.box.max().y());
    bottom = std::min(bottom, p.box.min().y());
  }
  return {Eigen::Vector2f(0, bottom), Eigen::Vector2f(width, top)};
}

// One row, or two for characters that are long rather than tall: whatever shows them larger.
Layout fit(const std::vector<Panel>& panels, const PictureOptions& options) {
  Layout best{1, 0};
  for (const std::size_t rows : {std::size_t{1}, std::size_t{2}}) {
    const float h = static_cast<float>(options.height) / static_cast<float>(rows), w = static_cast<float>(options.width);
    float scale = std::numeric_limits<float>::max();
    for (std::size_t r = 0; r < rows; ++r) {
      const auto row = row_of(panels, rows, r);
      const Eigen::Vector2f size = row_box(row).sizes().cwiseMax(1e-12f);
      const float gaps = 0.07f * h * static_cast<float>(row.size());
      scale = std::min({scale, (w - gaps) / size.x(), 0.86f * h / size.y()});
    }
    if (scale > best.pixels_per_metre) best = {rows, scale};
  }
  return best;
}

// Draws a row of panels side by side, evenly spread; returns an image as wide as the picture.
Image draw_row(std::span<const Panel> row, float scale, const Backdrop& backdrop, int width, int height) {
  const Eigen::AlignedBox2f box = row_box(row);
  const float foot_line = 0.5f * static_cast<float>(height) + scale * box.center().y();
  const float gap = (static_cast<float>(width) - scale * box.sizes().x()) / static_cast<float>(row.size());
  Image image(width, height);
  float right = 0;  // of the panels drawn so far
  int left = 0;
  for (const Panel& p : row) {
    right += gap + scale * p.box.sizes().x();
    const int end = &p == &row.back() ? width : static_cast<int>(std::lround(right));
    const float middle = 0.5f * static_cast<float>(end - left) - scale * p.box.center().x();
    const Figure figure{p.mesh, p.colors, p.overlay ? &*p.overlay : nullptr, backdrop};
    paste(image, draw(figure, {view_axes(p.view), p.foot, {middle, foot_line}, scale}, end - left, height), left, 0);
    left = end;
  }
  return image;
}

}  // namespace

Image character_picture(const Character& character, const PictureOptions& options) {
  const auto all = panels(character);
  const Layout layout = fit(all, options);
  Image picture(options.width, options.height);
  const auto share = [&](std::size_t row) { return static_cast<float>(row) / static_cast<float>(layout.rows); };
  for (std::size_t r = 0; r < layout.rows; ++r) {
    const int top = static_cast<int>(share(r) * static_cast<float>(options.height));
    const int bottom = static_cast<int>(share(r + 1) * static_cast<float>(options.height));
    const auto row = row_of(all, layout.rows, r);
    paste(picture, draw_row(row, layout.pixels_per_metre, {share(r), share(r + 1)}, options.width, bottom - top), 0, top);
  }
  return picture;
}

}  // namespace osteon::render
