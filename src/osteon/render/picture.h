// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/render/image.h"
#include "osteon/rig/skeleton.h"
#include "osteon/rig/skin_weights.h"

namespace osteon::render {

// A character in another pose than its rest pose.
struct Posed {
  PerVertex<Vec3f> vertices;  // world space, metres
  PerJoint<Vec3f> joints;
};

// What there is of a character; a mesh without skeleton is drawn in one colour, one without weights too.
struct Character {
  const TriangleMesh& mesh;
  const Skeleton* skeleton = nullptr;
  const SkinWeights* weights = nullptr;
  const Posed* posed = nullptr;
};

struct PictureOptions {
  int width = 1600, height = 800;  // pixels
};

// The character from the front, from its right side and at an angle, all at one scale, in the colours of its skin weights (each joint its
// own colour, blended by weight) with the skeleton showing through; then, where given, in the pose.
Image character_picture(const Character& character, const PictureOptions& options = {});

}  // namespace osteon::render
