// SPDX-License-Identifier: Apache-2.0
#include "osteon/render/studio.h"

#include <algorithm>

namespace osteon::render::studio {
namespace {

const Vec3f key_direction = Vec3f(-0.45f, 0.75f, 0.65f).normalized();
const Vec3f between_key_and_viewer = (key_direction + Vec3f::UnitZ()).normalized();
const Vec3f key_light(1.22f, 1.16f, 1.06f), sky_light(0.50f, 0.55f, 0.62f), ground_light(0.34f, 0.31f, 0.29f),
    rim_light(0.20f, 0.22f, 0.26f);
const Vec3f backdrop_top(0.80f, 0.83f, 0.87f), backdrop_bottom(0.92f, 0.92f, 0.91f);

float cube(float x) { return x * x * x; }

float highlight(float cosine) {  // cosine^32
  float p = std::max(0.0f, cosine);
  for (int i = 0; i < 5; ++i) p *= p;
  return 0.10f * p;
}

}  // namespace

Vec3f to_key_light() { return key_direction; }

Vec3f shade(const Vec3f& color, const Vec3f& normal, float ambient, float key) {
  const float up = 0.5f * normal.y() + 0.5f;
  const Vec3f around = ambient * (up * sky_light + (1 - up) * ground_light);
  const float facing = std::max(0.0f, (normal.dot(key_direction) + 0.25f) / 1.25f);  // wraps a little around the edge: softer than Lambert
  const float rim = ambient * cube(1 - std::clamp(normal.z(), 0.0f, 1.0f)) * (0.35f + 0.65f * up);
  const Vec3f light = color.cwiseProduct(around + key * facing * key_light) + rim * rim_light +
                      Vec3f::Constant(key * highlight(normal.dot(between_key_and_viewer)));
  return light.array() / (1 + 0.22f * light.array());  // highlights roll off instead of clipping
}

Vec3f backdrop(float height, float darkness) {
  const Vec3f lit = (1 - height) * backdrop_top + height * backdrop_bottom;
  return (1 - 0.6f * darkness) * lit;
}

}  // namespace osteon::render::studio
