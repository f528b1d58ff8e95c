// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/rig/skeleton.h"
#include "osteon/rig/skin_weights.h"

// Colours are linear light, 0..1.
namespace osteon::render {

// Equal steps of lightness (0..1), chroma and hue (turns) look equal. Ottosson. A perceptual color space for image processing. 2020.
Vec3f oklch(float lightness, float chroma, float hue);

// A colour for each joint; joints that follow one another in the skeleton are far apart in hue (golden angle).
PerJoint<Vec3f> joint_colors(std::size_t joints);

// Each vertex in the mean of its joints' colours, weighted by its skin weights.
PerVertex<Vec3f> weight_colors(const SkinWeights& weights, const PerJoint<Vec3f>& joint_colors);

}  // namespace osteon::render
