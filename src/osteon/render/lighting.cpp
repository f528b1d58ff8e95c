// SPDX-License-Identifier: Apache-2.0
#include "osteon/render/lighting.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "osteon/base/parallel.h"

namespace osteon::render {
namespace {

constexpr int shadow_pixels = 1024;
constexpr int ground_pixels = 192;
constexpr std::size_t samples = 40;

// Points in the unit disc, denser towards the middle; point 2i+1 mirrors point 2i in x.
std::array<Eigen::Vector2f, samples> mirrored_spiral() {
  std::array<Eigen::Vector2f, samples> points;
  for (std::size_t i = 0; i < samples / 2; ++i) {
    const float share = (static_cast<float>(i) + 0.5f) / (samples / 2.0f);
    const float angle = std::numbers::pi_v<float> * (2 * share * 2.618034f * 2 + 0.5f * share);
    points[2 * i] = share * Eigen::Vector2f(std::cos(angle), std::sin(angle));
    points[2 * i + 1] = points[2 * i].cwiseProduct(Eigen::Vector2f(-1, 1));
  }
  return points;
}

float openness(const DepthAndNormals& seen, int x, int y, float pixels_per_metre, float radius) {
  static const auto pattern = mirrored_spiral();
  const float depth = seen.depths[seen.index(x, y)];
  const Vec3f normal = seen.normals[seen.index(x, y)];
  const float bias = 0.03f * radius, soft = 0.01f * radius * radius;
  float blocked = 0;
  for (const Eigen::Vector2f& offset : pattern) {
    const int px = x + static_cast<int>(std::lround(offset.x() * radius * pixels_per_metre));
    const int py = y + static_cast<int>(std::lround(offset.y() * radius * pixels_per_metre));
    if (px < 0 || py < 0 || px >= seen.width || py >= seen.height || !std::isfinite(seen.depths[seen.index(px, py)])) continue;
    const Vec3f to_sample(static_cast<float>(px - x) / pixels_per_metre, static_cast<float>(y - py) / pixels_per_metre,
                          seen.depths[seen.index(px, py)] - depth);
    const float distance2 = to_sample.squaredNorm();
    if (distance2 > 4 * radius * radius) continue;  // something far in front does not darken what lies behind
    blocked += std::max(0.0f, to_sample.dot(normal) - bias) / (distance2 + soft);
  }
  return std::max(0.0f, 1.0f - 1.6f * radius * blocked / samples);
}

// A camera that sees the whole mesh in `share` of a square picture.
Camera square_camera(const TriangleMesh& mesh, const View& view, int pixels, float share) {
  const Eigen::AlignedBox3f box = seen_bounds(mesh.positions, view);
  Camera camera;
  camera.axes = view_axes(view);
  camera.target = camera.axes.transpose() * box.center();
  camera.centre = Eigen::Vector2f::Constant(static_cast<float>(pixels) / 2);
  camera.pixels_per_metre = share * static_cast<float>(pixels) / std::max({box.sizes().x(), box.sizes().y(), 1e-12f});
  return camera;
}

// The mean over 2 * reach + 1 values along rows (stride 1) or columns (stride ground_pixels) of a square map; 0 beyond its border.
void blur(std::vector<float>& map, int reach, std::size_t stride) {
  const auto n = static_cast<std::size_t>(ground_pixels), other = stride == 1 ? n : 1;
  const auto r = static_cast<std::size_t>(reach);
  std::vector<float> line(n);
  for (std::size_t row = 0; row < n; ++row) {
    float* values = map.data() + row * other;
    for (std::size_t i = 0; i < n; ++i) {
      float sum = 0;
      for (std::size_t k = i < r ? 0 : i - r; k <= std::min(n - 1, i + r); ++k) sum += values[k * stride];
      line[i] = sum / static_cast<float>(2 * r + 1);
    }
    for (std::size_t i = 0; i < n; ++i) values[i * stride] = line[i];
  }
}

}  // namespace

LightMap ambient_light(const DepthAndNormals& seen, const Camera& camera, float radius) {
  LightMap map{std::vector<float>(seen.depths.size(), 1.0f)};
  parallel_for(static_cast<std::size_t>(seen.height), 16, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
      for (int x = 0; x < seen.width; ++x)
        if (const std::size_t i = seen.index(x, y); std::isfinite(seen.depths[i]))
          map.values[i] = openness(seen, x, y, camera.pixels_per_metre, radius);
  });
  return map;
}

ShadowMap::ShadowMap(const TriangleMesh& mesh, const Vec3f& to_light) {
  const View view{std::atan2(to_light.x(), to_light.z()), std::asin(to_light.normalized().y())};
  camera_ = square_camera(mesh, view, shadow_pixels, 0.98f);
  bias_ = 3.0f / camera_.pixels_per_metre;
  seen_ = rasterize(project(mesh.positions, camera_), mesh.faces, shadow_pixels, shadow_pixels);
}

float ShadowMap::light_at(const Vec3f& p, float softness) const {
  const Vec3f q = camera_.project(p);
  constexpr int reach = 3;  // 7 x 7 samples
  const float step = std::max(1.0f, softness * camera_.pixels_per_metre / reach);
  int lit = 0;
  for (int dy = -reach; dy <= reach; ++dy)
    for (int dx = -reach; dx <= reach; ++dx) {
      const int x = static_cast<int>(std::floor(q.x() + step * static_cast<float>(dx)));
      const int y = static_cast<int>(std::floor(q.y() + step * static_cast<float>(dy)));
      const bool in_map = x >= 0 && y >= 0 && x < seen_.width && y < seen_.height;
      lit += !in_map || seen_.depths[seen_.index(x, y)] <=
                            q.z() + bias_ * (1.0f + static_cast<float>(std::max(std::abs(dx), std::abs(dy))) * step * 0.5f);
    }
  return static_cast<float>(lit) / ((2 * reach + 1) * (2 * reach + 1));
}

GroundShadow::GroundShadow(const TriangleMesh& mesh) : darkness_(static_cast<std::size_t>(ground_pixels * ground_pixels)) {
  const auto box = bounds(mesh);
  const float reach = 0.18f * box.diagonal().norm();
  camera_ = square_camera(mesh, {0, -std::numbers::pi_v<float> / 2}, ground_pixels, 0.7f);  // from below: the lowest point is the nearest
  camera_.target.y() = box.min().y();
  const VisibilityBuffer seen = rasterize(project(mesh.positions, camera_), mesh.faces, ground_pixels, ground_pixels);
  for (std::size_t i = 0; i < darkness_.size(); ++i)
    if (seen.faces[i] != nothing) darkness_[i] = std::exp(seen.depths[i] / reach);
  for (int pass = 0; pass < 3; ++pass)  // three box filters are nearly a Gaussian
    for (const std::size_t stride : {std::size_t{1}, static_cast<std::size_t>(ground_pixels)}) blur(darkness_, 4, stride);
}

float GroundShadow::darkness_at(const Vec3f& p) const {
  const Vec3f q = camera_.project(p);
  const float x = q.x() - 0.5f, y = q.y() - 0.5f;
  if (!(x >= 0 && y >= 0 && x < ground_pixels - 1 && y < ground_pixels - 1)) return 0;
  const auto ix = static_cast<std::size_t>(x), iy = static_cast<std::size_t>(y);
  const float fx = x - static_cast<float>(ix), fy = y - static_cast<float>(iy);
  const float* at = darkness_.data() + iy * ground_pixels + ix;
  return (1 - fy) * ((1 - fx) * at[0] + fx * at[1]) + fy * ((1 - fx) * at[ground_pixels] + fx * at[ground_pixels + 1]);
}

}  // namespace osteon::render
