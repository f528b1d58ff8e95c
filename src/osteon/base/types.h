// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace osteon {

// World space throughout: right-handed, y up, metres, a character faces +z (its left is +x), unless a comment says otherwise.
using Vec3f = Eigen::Vector3f;
using Quatf = Eigen::Quaternionf;
using Transform = Eigen::Affine3f;
using Matrix = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;  // rows are vertices, edges, joints, ...

struct Segment {
  Vec3f a, b;  // the two ends; may coincide
};

// Points with n·x = offset.
struct Plane {
  Vec3f normal;  // unit length
  float offset;

  float signed_distance(const Vec3f& p) const { return normal.dot(p) - offset; }
  Vec3f mirror(const Vec3f& p) const { return p - 2.0f * signed_distance(p) * normal; }
};

}  // namespace osteon
