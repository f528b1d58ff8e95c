// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "osteon/render/camera.h"
#include "osteon/render/rasterize.h"

namespace osteon::render {

constexpr int kFine = 3;  // a pixel is the mean of kFine x kFine samples

// What is seen of a surface at a point: its colour (linear light) and unit normal in the axes of the view, towards the viewer's side.
struct SurfaceSample {
  Vec3f color, normal;
};

// A coloured mesh as a camera sees it, sampled finer than the pixels.
class SurfaceView {
 public:
  // Faces that meet at more than `crease` (radians) keep a sharp edge. The mesh and the colours must outlive the view.
  SurfaceView(const TriangleMesh& mesh, const PerVertex<Vec3f>& colors, const Camera& camera, int width, int height, float crease);

  std::uint32_t face_at(int fine_x, int fine_y) const { return seen_.faces[seen_.index(fine_x, fine_y)]; }  // may be `nothing`
  float depth_at(int fine_x, int fine_y) const { return seen_.depths[seen_.index(fine_x, fine_y)]; }        // metres towards the viewer
  SurfaceSample sample(int fine_x, int fine_y) const;                                                       // pre: a face is seen there

  // Whether a face is seen at a sample of the pixel; whether at a fine sample or within two samples of it.
  bool covers(int x, int y) const;
  bool beside(int fine_x, int fine_y) const;

 private:
  const TriangleMesh& mesh_;
  const PerVertex<Vec3f>& colors_;
  Eigen::Matrix3f axes_;
  PerVertex<Vec3f> corners_;               // on the fine grid, see Camera::project
  PerFace<std::array<Vec3f, 3>> normals_;  // world axes
  VisibilityBuffer seen_;                  // on the fine grid
};

// The nearest surface seen in each pixel, in the axes of the view.
struct DepthAndNormals {
  int width = 0, height = 0;
  std::vector<float> depths;   // metres towards the viewer; -infinity where the background shows
  std::vector<Vec3f> normals;  // unit length

  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
  }
};
DepthAndNormals depth_and_normals(const SurfaceView& view, int width, int height);

}  // namespace osteon::render
