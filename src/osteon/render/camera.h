// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/mesh/triangle_mesh.h"

namespace osteon::render {

// From where a figure is seen, in radians. Yaw turns the viewer about +y: 0 looks at the front of a character (which faces +z),
// -90 degrees at its right side, so that it faces right in the picture. Pitch lifts the viewer.
struct View {
  float yaw = 0, pitch = 0;
};

// A parallel projection: x right and y down in pixels, z towards the viewer in metres.
struct Camera {
  Eigen::Matrix3f axes = Eigen::Matrix3f::Identity();  // rows: right, up and towards the viewer, in world space
  Vec3f target = Vec3f::Zero();                        // the world point that is seen at `centre`
  Eigen::Vector2f centre = Eigen::Vector2f::Zero();    // pixels
  float pixels_per_metre = 1;

  Vec3f project(const Vec3f& p) const;
};

Eigen::Matrix3f view_axes(const View& view);

PerVertex<Vec3f> project(const PerVertex<Vec3f>& positions, const Camera& camera);

// The box around the points in the axes of the view, metres: x right, y up, z towards the viewer.
Eigen::AlignedBox3f seen_bounds(const PerVertex<Vec3f>& positions, const View& view);

}  // namespace osteon::render
