// SPDX-License-Identifier: Apache-2.0
#include "osteon/synth/accessories.h"

#include <cassert>

#include "osteon/mesh/shapes.h"
#include "osteon/synth/pieces.h"

namespace osteon::synth {
namespace {

// Rings about the vertical through the skull's centre, in half sizes of the skull: height, radius.
TriangleMesh turned(const Vec3f& skull, const Vec3f& half, const std::vector<Eigen::Vector2f>& profile, float back = 0.0f) {
  std::vector<Ring> rings;
  for (const Eigen::Vector2f& p : profile)
    rings.push_back({skull + Vec3f(0, p.x() * half.y(), -back * half.z()), p.y() * half.x(), p.y() * half.z()});
  return tube(rings, 12);
}

TriangleMesh hair(const Vec3f& skull, const Vec3f& half) {
  TriangleMesh mesh = shapes::icosphere(2);
  for (Vec3f& p : mesh.positions) p = skull + Vec3f(0, 0.2f * half.y(), -0.22f * half.z()) + 1.02f * p.cwiseProduct(half);
  return mesh;
}

}  // namespace

Outfit::Outfit(Random& random) {
  const auto chance = [&](float share) { return random.uniform() < share; };
  if (chance(0.5f)) headgear = static_cast<Headgear>(1 + random.below(6));
  if (chance(0.15f)) right = chance(0.6f) ? Held::Sword : Held::Staff;
  if (chance(0.12f)) left = Held::Shield;
  backpack = chance(0.15f);
  belt = chance(0.2f);
  if (chance(0.15f)) skirt = random.uniform(0.3f, 1.0f);
}

TriangleMesh headgear(Headgear kind, const Vec3f& skull, const Vec3f& half) {
  switch (kind) {
    case Headgear::None:
      break;
    case Headgear::Hair:
      return hair(skull, half);
    case Headgear::LongHair:
      return shapes::merged(hair(skull, half), turned(skull, half, {{-1.9f, 0.5f}, {-1.0f, 0.75f}, {0.2f, 0.8f}}, 0.55f));
    case Headgear::Cap:
      return turned(skull, half, {{0.25f, 1.06f}, {0.7f, 0.92f}, {1.05f, 0.5f}, {1.12f, 0.1f}}, 0.05f);
    case Headgear::TopHat:
      return turned(skull, half, {{0.5f, 1.5f}, {0.58f, 1.5f}, {0.6f, 0.95f}, {1.7f, 1.0f}}, 0.05f);
    case Headgear::Cone:
      return turned(skull, half, {{0.45f, 1.4f}, {0.6f, 1.0f}, {1.5f, 0.5f}, {2.4f, 0.03f}}, 0.05f);
    case Headgear::Helmet:
      return turned(skull, half, {{-0.25f, 1.12f}, {0.3f, 1.15f}, {0.8f, 0.9f}, {1.15f, 0.4f}, {1.4f, 0.05f}}, 0.18f);
  }
  assert(false);
  return {};
}

TriangleMesh held(Held kind, const Vec3f& grip, const Vec3f& along, const Vec3f& outwards, float size) {
  const auto at = [&](float t) { return Vec3f(grip + t * size * along); };
  switch (kind) {
    case Held::None:
      break;
    case Held::Sword: {
      const TriangleMesh hilt = tube({{at(-0.12f), 0.018f * size, 0.018f * size}, {at(0.07f), 0.018f * size, 0.018f * size}}, 6, outwards);
      const TriangleMesh guard = tube({{at(0.07f), 0.02f * size, 0.09f * size}, {at(0.1f), 0.02f * size, 0.09f * size}}, 4, outwards);
      const TriangleMesh blade = tube(
          {{at(0.1f), 0.01f * size, 0.035f * size}, {at(0.7f), 0.009f * size, 0.03f * size}, {at(0.82f), 0.003f * size, 0.004f * size}}, 4,
          outwards);
      return shapes::merged(shapes::merged(hilt, guard), blade);
    }
    case Held::Staff:
      return shapes::merged(tube({{at(-0.7f), 0.016f * size, 0.016f * size}, {at(0.75f), 0.02f * size, 0.02f * size}}, 7, outwards),
                            ball(at(0.8f), 0.06f * size, 1));
    case Held::Shield: {
      const auto ring = [&](float out, float radius) { return Ring{grip + out * size * outwards, radius * size, radius * size}; };
      return tube({ring(0.05f, 0.26f), ring(0.075f, 0.27f), ring(0.11f, 0.16f), ring(0.12f, 0.03f)}, 12, along);
    }
  }
  assert(false);
  return {};
}

TriangleMesh backpack(const Vec3f& back, float width, float height) {
  const float depth = 0.55f * width;
  const Vec3f middle = back - Vec3f(0, 0, 0.5f * depth);
  return shapes::merged(block(middle, {width, height, depth}),
                        block(middle - Vec3f(0, 0.15f * height, 0.62f * depth), {0.75f * width, 0.45f * height, 0.3f * depth}));
}

TriangleMesh belt(const Vec3f& centre, float width, float depth, float height) {
  const Vec3f up(0, 0.5f * height, 0);
  return tube({{centre - up, 0.97f * width, 0.97f * depth}, {centre, width, depth}, {centre + up, 0.97f * width, 0.97f * depth}}, 16);
}

}  // namespace osteon::synth
