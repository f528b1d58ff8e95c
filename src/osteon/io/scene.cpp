// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/scene.h"

namespace osteon::io {

Scene::Material Scene::Material::plain(std::string name) {
  Material material;
  material.name = std::move(name);
  material.colour = {0.8f, 0.8f, 0.8f, 1.0f};
  return material;
}

std::size_t repair_positions(std::span<Vec3f> positions) {
  std::size_t repaired = 0;
  for (Vec3f& p : positions) {
    if (std::abs(p.x()) <= kLargestCoordinate && std::abs(p.y()) <= kLargestCoordinate && std::abs(p.z()) <= kLargestCoordinate) continue;
    p.setZero();
    ++repaired;
  }
  return repaired;
}

}  // namespace osteon::io
