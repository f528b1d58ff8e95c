// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "osteon/render/camera.h"
#include "osteon/render/rasterize.h"
#include "osteon/render/surface_view.h"

namespace osteon::render {

// Light that depends on more than the surface itself, for each pixel: 0 dark, 1 fully lit.
struct LightMap {
  std::vector<float> values;  // row-major; 1 where nothing is seen
};

// How open each point is to the light around it, from the depths of the pixels near it.
// McGuire, Osman, Bukowski, Hennessy. The Alchemy screen-space ambient obscurance algorithm. HPG 2011, eq. 10. Differs: the sample pattern
// is the same mirror-symmetric spiral for each pixel (many samples, no noise to blur). `radius` in metres.
LightMap ambient_light(const DepthAndNormals& seen, const Camera& camera, float radius);

// The depths of a figure seen from a light, to tell what lies in its shadow.
// Williams. Casting curved shadows on curved surfaces. SIGGRAPH 1978.
class ShadowMap {
 public:
  ShadowMap(const TriangleMesh& mesh, const Vec3f& to_light);
  // Share of the light that reaches p, softened over the given radius (metres).
  float light_at(const Vec3f& p, float softness) const;

 private:
  Camera camera_;
  VisibilityBuffer seen_;
  float bias_ = 0;
};

// The soft shadow of a figure on the level ground at its lowest point, under a wide sky: dark where the figure touches the ground, fading
// with its height above it.
class GroundShadow {
 public:
  explicit GroundShadow(const TriangleMesh& mesh);
  // How dark the ground is at p, 0..1; p.y() is not read.
  float darkness_at(const Vec3f& p) const;

 private:
  Camera camera_;
  std::vector<float> darkness_;
};

}  // namespace osteon::render
