// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/base/random.h"
#include "osteon/mesh/triangle_mesh.h"

// Things that a character wears or holds, as meshes to be attached. Metres, world space.
namespace osteon::synth {

enum class Headgear { None, Hair, LongHair, Cap, TopHat, Cone, Helmet };
enum class Held { None, Sword, Staff, Shield };

// What a character carries, drawn from a seed; most carry nothing or one thing.
struct Outfit {
  Headgear headgear = Headgear::None;
  Held right = Held::None, left = Held::None;
  bool backpack = false, belt = false;
  float skirt = 0.0f;  // 0 none .. 1 to the ankles

  Outfit() = default;
  explicit Outfit(Random& random);
};

// On a skull of the given centre and half sizes (width, height, depth). Pre: not None.
TriangleMesh headgear(Headgear kind, const Vec3f& skull, const Vec3f& half);
// In a fist at `grip` that closes around `along`; a shield stands before it, facing `outwards`. Pre: not None.
TriangleMesh held(Held kind, const Vec3f& grip, const Vec3f& along, const Vec3f& outwards, float size);
// Against a back at `back`, facing -z.
TriangleMesh backpack(const Vec3f& back, float width, float height);
// Around a waist of the given half width and half depth.
TriangleMesh belt(const Vec3f& centre, float width, float depth, float height);

}  // namespace osteon::synth
