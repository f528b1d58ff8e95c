// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Geometry>
#include <string>

#include "osteon/rig/rig.h"

namespace osteon::pipelines {

// How a skeleton of another file is brought to a body.
struct SkeletonFit {
  Eigen::Affine3d to_body = Eigen::Affine3d::Identity();  // a similarity
  std::string note;                                       // what was done about it, or is wrong; empty where it fits as it is
};

// As it is where nine of ten joints lie in the body's bounding box, a twentieth larger, and span a quarter of its longest side. Else the
// usual mistakes are tried: units (mm, cm, inches, m), z up for y up and the other way round; and if none of them fits, the skeleton is
// scaled to 0.9 of the body's height and put in its middle, standing on its ground. What is beside the
// character (geometry/surroundings.h) does not count.
SkeletonFit fit_skeleton(const Skeleton& skeleton, const TriangleMesh& body);

}  // namespace osteon::pipelines
