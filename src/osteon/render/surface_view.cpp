// SPDX-License-Identifier: Apache-2.0
#include "osteon/render/surface_view.h"

#include "osteon/base/parallel.h"
#include "osteon/render/corner_normals.h"

namespace osteon::render {
namespace {

Camera finer(Camera camera) {
  camera.centre *= kFine;
  camera.pixels_per_metre *= kFine;
  return camera;
}

float cross(const Eigen::Vector2f& u, const Eigen::Vector2f& v) { return u.x() * v.y() - u.y() * v.x(); }

// Barycentric coordinates of p, pulled inside where rounding (or a face seen edge-on) put them outside.
Vec3f barycentric(const Eigen::Vector2f& p, const Eigen::Vector2f& a, const Eigen::Vector2f& b, const Eigen::Vector2f& c) {
  const Vec3f weights = Vec3f(cross(c - b, p - b), cross(a - c, p - c), cross(b - a, p - a)) / cross(b - a, c - a);
  const Vec3f inside = weights.array().isFinite().select(weights, 0.0f).cwiseMax(0.0f);
  const float sum = inside.sum();
  return sum > 0 ? Vec3f(inside / sum) : Vec3f::Constant(1.0f / 3);
}

}  // namespace

SurfaceView::SurfaceView(const TriangleMesh& mesh, const PerVertex<Vec3f>& colors, const Camera& camera, int width, int height,
                         float crease)
    : mesh_(mesh),
      colors_(colors),
      axes_(camera.axes),
      corners_(project(mesh.positions, finer(camera))),
      normals_(corner_normals(mesh, crease)),
      seen_(rasterize(corners_, mesh.faces, width * kFine, height * kFine)) {}

SurfaceSample SurfaceView::sample(int fine_x, int fine_y) const {
  const auto face = static_cast<FaceId>(face_at(fine_x, fine_y));
  const Triangle& t = mesh_.faces[face];
  const Eigen::Vector2f p(static_cast<float>(fine_x) + 0.5f, static_cast<float>(fine_y) + 0.5f);
  const Eigen::Vector2f a = corners_[t[0]].head<2>(), b = corners_[t[1]].head<2>(), c = corners_[t[2]].head<2>();
  const Vec3f weights = barycentric(p, a, b, c);
  SurfaceSample out{Vec3f::Zero(), Vec3f::Zero()};
  for (std::size_t i = 0; i < 3; ++i) {
    out.color += weights[static_cast<int>(i)] * colors_[t[i]];
    out.normal += weights[static_cast<int>(i)] * normals_[face][i];
  }
  out.normal = (axes_ * out.normal).normalized();
  const bool from_behind = cross(b - a, c - a) > 0;  // y is down: counter-clockwise faces have a negative area
  if (from_behind) out.normal = -out.normal;         // a sheet has two sides
  return out;
}

bool SurfaceView::covers(int x, int y) const {
  for (int s = 0; s < kFine * kFine; ++s)
    if (face_at(x * kFine + s % kFine, y * kFine + s / kFine) != nothing) return true;
  return false;
}

bool SurfaceView::beside(int fine_x, int fine_y) const {
  constexpr int reach = 2;
  for (int dy = -reach; dy <= reach; ++dy)
    for (int dx = -reach; dx <= reach; ++dx) {
      const int x = fine_x + dx, y = fine_y + dy;
      if (dx * dx + dy * dy <= reach * reach && x >= 0 && y >= 0 && x < seen_.width && y < seen_.height && face_at(x, y) != nothing)
        return true;
    }
  return false;
}

DepthAndNormals depth_and_normals(const SurfaceView& view, int width, int height) {
  const std::size_t pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  DepthAndNormals out{width, height, std::vector<float>(pixels, -std::numeric_limits<float>::infinity()),
                      std::vector<Vec3f>(pixels, Vec3f::UnitZ())};
  parallel_for(static_cast<std::size_t>(height), 16, [&](std::size_t begin, std::size_t end) {
    for (int y = static_cast<int>(begin); y < static_cast<int>(end); ++y)
      for (int x = 0; x < width; ++x) {
        const std::size_t i = out.index(x, y);
        int nearest = -1;
        for (int s = 0; s < kFine * kFine; ++s)
          if (const float depth = view.depth_at(x * kFine + s % kFine, y * kFine + s / kFine); depth > out.depths[i])
            out.depths[i] = depth, nearest = s;
        if (nearest >= 0) out.normals[i] = view.sample(x * kFine + nearest % kFine, y * kFine + nearest / kFine).normal;
      }
  });
  return out;
}

}  // namespace osteon::render
