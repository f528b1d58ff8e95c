// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/body_frame.h"

#include <cmath>

#include "osteon/geometry/box_of_faces.h"
#include "osteon/geometry/stance.h"

namespace osteon::pipelines {
namespace {

constexpr float kWithinFiveDegrees = 0.996f;  // cosine
constexpr float kHorizontal = 0.9f;           // of the normal
// A finer side that lies less than this from the middle says little of which way is the front: then it is +z of the file, as glTF has it.
constexpr float kClearlyFiner = 0.01f;
// Less than this is rounding, and the shape alike before and behind: then its widest side is taken to go from left to right.
constexpr float kFiner = 1e-3f;

Eigen::Matrix3f with_widest_side_along_x(const Eigen::Matrix3f& turn, const TriangleMesh& mesh) {
  const Vec3f sides = geometry::box_of_faces(turned(mesh, turn)).sizes();
  return sides.z() > sides.x() ? Eigen::Matrix3f(geometry::turn_to_front(Vec3f::UnitX()) * turn) : turn;
}

bool is_seen_from_behind(const BodyFrame& frame, const Vec3f& finer) {
  const Vec3f front_of_file = frame.is_z_up ? Vec3f(0, -1, 0) : Vec3f(0, 0, 1);
  return finer.norm() < kClearlyFiner && (frame.turn * front_of_file).z() < -0.5f;
}

}  // namespace

TriangleMesh turned(TriangleMesh mesh, const Eigen::Matrix3f& turn) {
  for (Vec3f& p : mesh.positions) p = turn * p;
  return mesh;
}

BodyFrame body_frame(const TriangleMesh& mesh, Up up) {
  BodyFrame frame;
  frame.is_z_up = up == Up::z || (up == Up::automatic && geometry::stance(mesh) == geometry::Stance::on_z);
  if (frame.is_z_up) frame.turn = geometry::turn_z_up_to_y_up();
  const Vec3f finer = geometry::finer_side(frame.is_z_up ? turned(mesh, frame.turn) : mesh);
  const bool is_along_x = std::abs(finer.x()) > std::abs(finer.z()) && finer.norm() >= kFiner;
  const Vec3f front = is_along_x ? Vec3f(finer.x() < 0.0f ? -1.0f : 1.0f, 0, 0) : Vec3f(0, 0, finer.z() < 0.0f ? -1.0f : 1.0f);
  frame.turn = geometry::turn_to_front(front) * frame.turn;
  if (finer.norm() < kFiner) frame.turn = with_widest_side_along_x(frame.turn, mesh);
  frame.is_seen_from_behind = is_seen_from_behind(frame, finer);
  return frame;
}

std::optional<BodyFrame> aligned(const BodyFrame& before, const Plane& symmetry, const TriangleMesh& mesh) {
  const Vec3f level(symmetry.normal.x(), 0.0f, symmetry.normal.z());
  if (level.norm() < kHorizontal || std::abs(level.x()) > kWithinFiveDegrees * level.norm()) return std::nullopt;
  const Vec3f finer = geometry::finer_side(turned(mesh, before.turn));
  const Vec3f front = level.normalized().cross(Vec3f::UnitY());
  BodyFrame frame = before;
  frame.turn = geometry::turn_to_front(front.dot(finer) < 0.0f ? Vec3f(-front) : front) * before.turn;
  // Of two planes at right angles, which a shape alike before and behind has, any may have been found first.
  const bool is_along_z = std::abs(level.z()) > kWithinFiveDegrees * level.norm();
  if (finer.norm() < kFiner && !is_along_z) frame.turn = with_widest_side_along_x(frame.turn, mesh);
  frame.is_seen_from_behind = is_seen_from_behind(frame, finer);
  return frame;
}

}  // namespace osteon::pipelines
