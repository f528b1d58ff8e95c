// SPDX-License-Identifier: Apache-2.0
#include "osteon/render/rasterize.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "osteon/base/parallel.h"

// Pineda. A parallel algorithm for polygon rasterization. SIGGRAPH 1988: a point is inside where three edge functions are positive.
namespace osteon::render {
namespace {

constexpr int band_rows = 32;
constexpr std::int64_t step = 256;   // fixed point: 1/256 pixel
constexpr float far_away = 1 << 22;  // pixels; beyond it fixed point would overflow, and nobody looks there

struct Corner {
  std::int64_t x, y;  // in 1/256 pixel
  float z;
};

struct Drawn {
  std::array<Corner, 3> corners;  // clockwise on the screen (y is down), so that edge functions are positive inside
  int left, right, top, bottom;   // pixels whose centre may be inside, inclusive
};

std::int64_t edge(const Corner& a, const Corner& b, std::int64_t x, std::int64_t y) {
  return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
}

// A pixel exactly on an edge is taken on top and left edges only.
std::int64_t tie_break(const Corner& a, const Corner& b) { return (a.y == b.y ? b.x > a.x : b.y < a.y) ? 0 : -1; }

std::int64_t first_centre(std::int64_t fixed) { return (fixed - step / 2 + step - 1) >> 8; }
std::int64_t last_centre(std::int64_t fixed) { return (fixed - step / 2) >> 8; }

std::optional<Drawn> set_up(const PerVertex<Vec3f>& corners, const Triangle& face, int width, int height) {
  Drawn t;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3f& p = corners[face[i]];
    if (!(std::abs(p.x()) < far_away && std::abs(p.y()) < far_away)) return {};
    t.corners[i] = {std::llround(p.x() * static_cast<float>(step)), std::llround(p.y() * static_cast<float>(step)), p.z()};
  }
  auto& [a, b, c] = t.corners;
  const std::int64_t area = edge(a, b, c.x, c.y);
  if (area == 0) return {};
  if (area < 0) std::swap(b, c);
  const auto [low_x, high_x] = std::minmax({a.x, b.x, c.x});
  const auto [low_y, high_y] = std::minmax({a.y, b.y, c.y});
  t.left = static_cast<int>(std::max<std::int64_t>(0, first_centre(low_x)));
  t.right = static_cast<int>(std::min<std::int64_t>(width - 1, last_centre(high_x)));
  t.top = static_cast<int>(std::max<std::int64_t>(0, first_centre(low_y)));
  t.bottom = static_cast<int>(std::min<std::int64_t>(height - 1, last_centre(high_y)));
  if (t.left > t.right || t.top > t.bottom) return {};
  return t;
}

void draw(VisibilityBuffer& buffer, const Drawn& t, std::uint32_t face, int first_row, int last_row) {
  const auto& [a, b, c] = t.corners;
  const double area = static_cast<double>(edge(a, b, c.x, c.y));
  const std::int64_t x0 = t.left * step + step / 2;
  for (int y = std::max(t.top, first_row); y <= std::min(t.bottom, last_row); ++y) {
    const std::int64_t cy = y * step + step / 2;
    std::int64_t wa = edge(b, c, x0, cy), wb = edge(c, a, x0, cy), wc = edge(a, b, x0, cy);
    const std::int64_t tie_a = tie_break(b, c), tie_b = tie_break(c, a), tie_c = tie_break(a, b);
    for (int x = t.left; x <= t.right; ++x) {
      if (((wa + tie_a) | (wb + tie_b) | (wc + tie_c)) >= 0) {
        const auto z =
            static_cast<float>((static_cast<double>(wa) * a.z + static_cast<double>(wb) * b.z + static_cast<double>(wc) * c.z) / area);
        const std::size_t i = buffer.index(x, y);
        if (z > buffer.depths[i]) buffer.depths[i] = z, buffer.faces[i] = face;
      }
      wa -= (c.y - b.y) * step, wb -= (a.y - c.y) * step, wc -= (b.y - a.y) * step;
    }
  }
}

}  // namespace

VisibilityBuffer rasterize(const PerVertex<Vec3f>& corners, const PerFace<Triangle>& faces, int width, int height) {
  VisibilityBuffer buffer{width, height, {}, {}};
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  buffer.faces.assign(pixels, nothing);
  buffer.depths.assign(pixels, -std::numeric_limits<float>::infinity());

  std::vector<std::optional<Drawn>> drawn(faces.size());
  parallel_for(faces.size(), 8192, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) drawn[f] = set_up(corners, faces.raw()[f], width, height);
  });
  const auto bands = static_cast<std::size_t>((height + band_rows - 1) / band_rows);
  std::vector<std::vector<std::uint32_t>> in_band(bands);
  for (std::size_t f = 0; f < drawn.size(); ++f)
    if (drawn[f])
      for (int band = drawn[f]->top / band_rows; band <= drawn[f]->bottom / band_rows; ++band)
        in_band[static_cast<std::size_t>(band)].push_back(static_cast<std::uint32_t>(f));
  parallel_for(bands, 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t band = begin; band < end; ++band)
      for (const std::uint32_t f : in_band[band])
        draw(buffer, *drawn[f], f, static_cast<int>(band) * band_rows, static_cast<int>(band + 1) * band_rows - 1);
  });
  return buffer;
}

}  // namespace osteon::render
