// SPDX-License-Identifier: Apache-2.0
#include "osteon/render/figure.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "osteon/base/parallel.h"
#include "osteon/render/lighting.h"
#include "osteon/render/studio.h"
#include "osteon/render/surface_view.h"

namespace osteon::render {
namespace {

constexpr float surface_crease = 0.9f, overlay_crease = 0.5f;
const Vec3f outline(0.03f, 0.035f, 0.05f);

// Everything that a pixel's colour is made of.
struct Scene {
  const Camera& camera;
  int width, height;
  Backdrop backdrop;
  float size, ground;  // of the mesh: its diagonal and its lowest point, metres
  SurfaceView surface;
  std::optional<SurfaceView> overlay;
  std::vector<std::uint8_t> near_overlay;  // by pixel: whether the overlay or its outline may be there
  DepthAndNormals seen;
  LightMap ambient;
  ShadowMap shadow;
  GroundShadow ground_shadow;
};

// The pixels that the overlay covers, and their neighbours.
std::vector<std::uint8_t> pixels_near(const SurfaceView& overlay, int width, int height) {
  std::vector<std::uint8_t> near(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      if (overlay.covers(x, y))
        for (int ny = std::max(0, y - 1); ny <= std::min(height - 1, y + 1); ++ny)
          for (int nx = std::max(0, x - 1); nx <= std::min(width - 1, x + 1); ++nx)
            near[static_cast<std::size_t>(ny) * static_cast<std::size_t>(width) + static_cast<std::size_t>(nx)] = 1;
  return near;
}

Scene prepare(const Figure& figure, const Camera& camera, int width, int height) {
  const auto box = bounds(figure.mesh);
  const float size = box.diagonal().norm();
  SurfaceView surface(figure.mesh, figure.colors, camera, width, height, surface_crease);
  std::optional<SurfaceView> overlay;
  if (figure.overlay) overlay.emplace(figure.overlay->mesh, figure.overlay->colors, camera, width, height, overlay_crease);
  auto near_overlay = overlay ? pixels_near(*overlay, width, height) : std::vector<std::uint8_t>();
  DepthAndNormals seen = depth_and_normals(surface, width, height);
  LightMap ambient = ambient_light(seen, camera, 0.05f * size);
  ShadowMap shadow(figure.mesh, camera.axes.transpose() * studio::to_key_light());
  return {camera,
          width,
          height,
          figure.backdrop,
          size,
          box.min().y(),
          std::move(surface),
          std::move(overlay),
          std::move(near_overlay),
          std::move(seen),
          std::move(ambient),
          std::move(shadow),
          GroundShadow(figure.mesh)};
}

// The world point at a depth behind the middle of a pixel.
Vec3f world_point(const Scene& scene, int x, int y, float depth) {
  const Camera& camera = scene.camera;
  return camera.target + camera.axes.transpose() * Vec3f((static_cast<float>(x) + 0.5f - camera.centre.x()) / camera.pixels_per_metre,
                                                         (camera.centre.y() - static_cast<float>(y) - 0.5f) / camera.pixels_per_metre,
                                                         depth);
}

float key_light_at(const Scene& scene, int x, int y) {
  const std::size_t i = scene.seen.index(x, y);
  if (!std::isfinite(scene.seen.depths[i])) return 1;
  const Vec3f off_surface = scene.camera.axes.transpose() * (0.004f * scene.size * scene.seen.normals[i]);  // it does not shade itself
  return scene.shadow.light_at(world_point(scene, x, y, scene.seen.depths[i]) + off_surface, 0.008f * scene.size);
}

Vec3f background_at(const Scene& scene, int x, int y) {
  const Backdrop& part = scene.backdrop;
  const float height = part.top + (part.bottom - part.top) * static_cast<float>(y) / static_cast<float>(scene.height);
  const Vec3f towards = scene.camera.axes.row(2);
  if (towards.y() < 0.02f) return studio::backdrop(height, 0);  // from the side the level ground is not seen
  const Vec3f p = world_point(scene, x, y, 0);
  return studio::backdrop(height, scene.ground_shadow.darkness_at(p - towards * ((p.y() - scene.ground) / towards.y())));
}

// What is inside the surface shows through it, with a dark outline.
Vec3f with_overlay(const Scene& scene, const Vec3f& below, int fine_x, int fine_y) {
  const SurfaceView& overlay = *scene.overlay;
  if (overlay.face_at(fine_x, fine_y) == nothing) return overlay.beside(fine_x, fine_y) ? Vec3f(0.35f * below + 0.65f * outline) : below;
  const float cover = overlay.depth_at(fine_x, fine_y) >= scene.surface.depth_at(fine_x, fine_y) ? 1.0f : 0.82f;
  const SurfaceSample s = overlay.sample(fine_x, fine_y);
  return (1 - cover) * below + cover * studio::shade(s.color, s.normal, 1, 0.8f);
}

// The mean of the samples. Each face is shaded once a pixel: within a pixel its colour hardly changes.
Vec3f pixel(const Scene& scene, int x, int y) {
  const Vec3f background = background_at(scene, x, y);
  const bool on_surface = std::isfinite(scene.seen.depths[scene.seen.index(x, y)]);
  const bool near_overlay = scene.overlay && scene.near_overlay[scene.seen.index(x, y)];
  if (!on_surface && !near_overlay) return background;
  const float ambient = scene.ambient.values[scene.seen.index(x, y)], key = key_light_at(scene, x, y);
  Vec3f sum = Vec3f::Zero(), color = background;
  std::uint32_t shaded = nothing;
  for (int s = 0; s < kFine * kFine; ++s) {
    const int fine_x = x * kFine + s % kFine, fine_y = y * kFine + s / kFine;
    if (const std::uint32_t face = scene.surface.face_at(fine_x, fine_y); face != shaded) {
      shaded = face;
      if (face == nothing) {
        color = background;
      } else {
        const SurfaceSample seen = scene.surface.sample(fine_x, fine_y);
        color = studio::shade(seen.color, seen.normal, ambient, key);
      }
    }
    sum += near_overlay ? with_overlay(scene, color, fine_x, fine_y) : color;
  }
  return sum / (kFine * kFine);
}

}  // namespace

Image draw(const Figure& figure, const Camera& camera, int width, int height) {
  const Scene scene = prepare(figure, camera, width, height);
  Image image(width, height);
  parallel_for(static_cast<std::size_t>(height), 8, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
      for (int x = 0; x < width; ++x) image.at(x, y) = encode_srgb(pixel(scene, x, y));
  });
  return image;
}

}  // namespace osteon::render
