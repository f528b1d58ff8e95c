// SPDX-License-Identifier: Apache-2.0
#include "osteon/render/palette.h"

#include <cmath>
#include <numbers>

namespace osteon::render {

Vec3f oklch(float lightness, float chroma, float hue) {
  const float angle = 2 * std::numbers::pi_v<float> * hue;
  const Vec3f lab(lightness, chroma * std::cos(angle), chroma * std::sin(angle));
  Eigen::Matrix3f to_cones, to_srgb;
  to_cones << 1, 0.3963377774f, 0.2158037573f, 1, -0.1055613458f, -0.0638541728f, 1, -0.0894841775f, -1.2914855480f;
  to_srgb << 4.0767416621f, -3.3077115913f, 0.2309699292f, -1.2684380046f, 2.6097574011f, -0.3413193965f, -0.0041960863f, -0.7034186147f,
      1.7076147010f;
  const Vec3f cones = (to_cones * lab).array().cube();
  return (to_srgb * cones).cwiseMax(0.0f).cwiseMin(1.0f);
}

PerJoint<Vec3f> joint_colors(std::size_t joints) {
  PerJoint<Vec3f> colors(joints);
  for (const JointId j : colors.ids()) {
    const auto i = static_cast<float>(index(j));
    const float lightness = 0.68f + 0.09f * static_cast<float>(static_cast<int>(index(j)) % 3 - 1);
    colors[j] = oklch(lightness, 0.14f, std::fmod(0.08f + i * 0.381966f, 1.0f));
  }
  return colors;
}

PerVertex<Vec3f> weight_colors(const SkinWeights& weights, const PerJoint<Vec3f>& joint_colors) {
  PerVertex<Vec3f> colors(weights.size());
  for (const VertexId v : colors.ids())
    for (const auto& [joint, weight] : weights[v]) colors[v] += weight * joint_colors[joint];
  return colors;
}

}  // namespace osteon::render
