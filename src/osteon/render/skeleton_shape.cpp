// SPDX-License-Identifier: Apache-2.0
#include "osteon/render/skeleton_shape.h"

#include <algorithm>

#include "osteon/mesh/shapes.h"

namespace osteon::render {
namespace {

const Vec3f bone_color(0.86f, 0.85f, 0.82f);

// Radius of the ball at each joint: at most `thickness`, and small enough that balls along short bones stay apart.
PerJoint<float> ball_radii(const Skeleton& skeleton, const PerJoint<Vec3f>& positions, float thickness) {
  PerJoint<float> radii(skeleton.size(), thickness);
  for (const JointId j : skeleton.names.ids())
    if (const auto parent = skeleton.parents[j]) {
      const float fitting = std::max(0.28f * (positions[j] - positions[*parent]).norm(), 0.35f * thickness);
      radii[j] = std::min(radii[j], fitting);
      radii[*parent] = std::min(radii[*parent], fitting);
    }
  return radii;
}

void append(ColoredMesh& whole, const TriangleMesh& part, const Vec3f& color) {
  const std::size_t first = whole.mesh.positions.size();
  for (const Vec3f& p : part.positions) {
    whole.mesh.positions.push_back(p);
    whole.colors.push_back(color);
  }
  for (const Triangle& t : part.faces) {
    Triangle moved;
    std::ranges::transform(t, moved.begin(), [&](VertexId v) { return static_cast<VertexId>(first + index(v)); });
    whole.mesh.faces.push_back(moved);
  }
}

// Six vertices: the two ends and a square ring of the given radius, a little beyond the parent.
TriangleMesh octahedron(const Vec3f& parent, const Vec3f& child, float radius) {
  const Vec3f along = child - parent;
  const Vec3f side = along.unitOrthogonal(), other = along.normalized().cross(side);
  const Vec3f middle = parent + 0.14f * along;
  TriangleMesh mesh;
  for (const Vec3f& p : {parent, child, Vec3f(middle + radius * side), Vec3f(middle + radius * other), Vec3f(middle - radius * side),
                         Vec3f(middle - radius * other)})
    mesh.positions.push_back(p);
  const auto vertex = [](std::size_t i) { return static_cast<VertexId>(i); };
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t a = 2 + i, b = 2 + (i + 1) % 4;
    mesh.faces.push_back({vertex(1), vertex(a), vertex(b)});
    mesh.faces.push_back({vertex(0), vertex(b), vertex(a)});
  }
  return mesh;
}

}  // namespace

ColoredMesh skeleton_shape(const Skeleton& skeleton, const PerJoint<Vec3f>& positions, const PerJoint<Vec3f>& joint_colors,
                           float thickness) {
  const auto radii = ball_radii(skeleton, positions, thickness);
  const TriangleMesh ball = shapes::icosphere(2);
  ColoredMesh out;
  for (const JointId j : skeleton.names.ids()) {
    append(out, shapes::transformed(ball, Transform(Eigen::Translation3f(positions[j]) * Eigen::Scaling(radii[j]))), joint_colors[j]);
    const auto parent = skeleton.parents[j];
    if (!parent || (positions[j] - positions[*parent]).norm() < 1e-6f * thickness) continue;
    const float length = (positions[j] - positions[*parent]).norm();
    append(out, octahedron(positions[*parent], positions[j], std::min({0.1f * length + 0.25f * thickness, 1.3f * thickness})), bone_color);
  }
  return out;
}

}  // namespace osteon::render
