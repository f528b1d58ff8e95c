// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/stance.h"

#include <algorithm>

#include "osteon/geometry/box_of_faces.h"

namespace osteon::geometry {
namespace {

constexpr float kStanding = 0.05f, kSunkDeeper = 0.15f;

float sunk(const Eigen::AlignedBox3f& box, Eigen::Index axis) {
  const float height = box.sizes()[axis];
  return height > 0.0f ? std::clamp(-box.min()[axis] / height, 0.0f, 0.5f) : 0.5f;
}

}  // namespace

Stance stance(const TriangleMesh& mesh) {
  const Eigen::AlignedBox3f box = box_of_faces(mesh);
  const float y = sunk(box, 1), z = sunk(box, 2);
  if (z < kStanding && y >= z + kSunkDeeper) return Stance::on_z;
  return y < kStanding && z >= y + kSunkDeeper ? Stance::on_y : Stance::unclear;
}

Vec3f finer_side(const TriangleMesh& mesh) {
  const Eigen::AlignedBox3f box = box_of_faces(mesh);
  const Eigen::Vector3d origin = box.center().cast<double>();
  Eigen::Vector3d of_faces = Eigen::Vector3d::Zero(), of_surface = Eigen::Vector3d::Zero();
  double area = 0.0;
  for (FaceId f : mesh.faces.ids()) {
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    for (VertexId v : mesh.faces[f]) middle += (mesh.positions[v].cast<double>() - origin) / 3.0;
    const auto a = static_cast<double>(area_vector(mesh, f).norm());
    of_faces += middle;
    of_surface += a * middle;
    area += a;
  }
  if (!(area > 0.0)) return Vec3f::Zero();
  const Eigen::Vector3d way = of_faces / static_cast<double>(mesh.faces.size()) - of_surface / area;
  return Vec3f(static_cast<float>(way.x()), 0.0f, static_cast<float>(way.z())) / box.sizes().maxCoeff();
}

Eigen::Matrix3f turn_to_front(const Vec3f& direction) {
  Eigen::Matrix3f turn;
  turn << direction.z(), 0.0f, -direction.x(), 0.0f, 1.0f, 0.0f, direction.x(), 0.0f, direction.z();
  return turn;
}

Eigen::Matrix3f turn_z_up_to_y_up() {
  Eigen::Matrix3f turn;
  turn << 1.0f, 0.0f, 0.0f, 0.0f, 0.0f, 1.0f, 0.0f, -1.0f, 0.0f;
  return turn;
}

}  // namespace osteon::geometry
