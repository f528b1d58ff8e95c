// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/body_lines.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace osteon::geometry {
namespace {

constexpr float kArrival = -0.3f;   // least cosine of a line and the normal where it arrives; below 0 for vertices in folds
constexpr float kInwards = -0.05f;  // largest cosine of a line and the normal of a face where it starts
constexpr float kPast = 1e-5f;      // how far beyond a hit a ray goes on
constexpr int kMostCrossings = 32;  // of one line, more than the layers of any clothing

// Van Oosterom and Strackee, "The solid angle of a plane triangle", 1983, equation 8.
double solid_angle(const TriangleMesh& mesh, const Triangle& face, const Vec3f& p) {
  const Eigen::Vector3d a = (mesh.positions[face[0]] - p).cast<double>(), b = (mesh.positions[face[1]] - p).cast<double>(),
                        c = (mesh.positions[face[2]] - p).cast<double>();
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  return 2.0 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

// 1 inside a closed part, 2 inside two, 0 outside, and something between near holes (Jacobson et al. 2013, equation 3).
double winding_number(const TriangleMesh& mesh, const Vec3f& p) {
  double sum = 0.0;
  for (const Triangle& face : mesh.faces) sum += solid_angle(mesh, face, p);
  return sum / (4.0 * std::numbers::pi);
}

}  // namespace

BodyLines::BodyLines(const TriangleMesh& mesh, const VoxelGrid& grid)
    : mesh_(mesh), grid_(grid), surface_(mesh), normals_(mesh.positions.size()), normals_around_(mesh.positions.size()) {
  for (FaceId f : mesh.faces.ids()) {
    const Vec3f area = area_vector(mesh, f);
    if (area.isZero(0.0f)) continue;
    for (VertexId v : mesh.faces[f]) {
      normals_[v] += area;
      normals_around_[v].push_back(area.stableNormalized());
    }
  }
  for (Vec3f& n : normals_) n.stableNormalize();
}

bool BodyLines::is_inside(const Vec3f& p) const {
  const Voxel voxel = grid_.at(p);
  return voxel == Voxel::Interior || (voxel == Voxel::Surface && winding_number(mesh_, p) >= 0.5);
}

bool BodyLines::sees(const Vec3f& from, VertexId v) const {
  const Vec3f line = mesh_.positions[v] - from;
  const float length = line.norm();
  if (length <= kPast) return true;
  const Vec3f direction = line / length;
  return normals_[v].dot(direction) >= kArrival && !passes_outside(from, line) && !way_out(from, direction, length, v);
}

std::optional<RayHit> BodyLines::opposite(VertexId v, const Vec3f& direction) const {
  if (!points_inwards(v, direction)) return std::nullopt;
  const auto hit = way_out(mesh_.positions[v], direction, std::numeric_limits<float>::infinity(), v);
  return hit && !passes_outside(mesh_.positions[v], hit->distance * direction) ? hit : std::nullopt;
}

// Where a line that starts in one part leaves the last of all. Faces at the vertex `ignored`, an end of the line, do not count.
std::optional<RayHit> BodyLines::way_out(const Vec3f& from, const Vec3f& direction, float length, VertexId ignored) const {
  float travelled = 0.0f;
  int parts = 1;
  for (int crossing = 0; crossing < kMostCrossings && travelled < length; ++crossing) {
    const auto hit = surface_.first_hit(from + travelled * direction, direction, length - travelled);
    if (!hit) return std::nullopt;
    const Triangle& corners = mesh_.faces[hit->face];
    if (std::ranges::find(corners, ignored) == corners.end()) parts += area_vector(mesh_, hit->face).dot(direction) > 0.0f ? -1 : 1;
    if (parts == 0) return RayHit{hit->face, travelled + hit->distance};
    travelled += hit->distance + kPast;
  }
  return std::nullopt;
}

// A cheap look ahead of the rays, which settles most lines.
bool BodyLines::passes_outside(const Vec3f& from, const Vec3f& line) const {
  const int steps = static_cast<int>(line.norm() / grid_.cell);
  for (int i = 1; i < steps; ++i)
    if (grid_.at(from + static_cast<float>(i) / static_cast<float>(steps) * line) == Voxel::Outside) return true;
  return false;
}

bool BodyLines::points_inwards(VertexId v, const Vec3f& direction) const {
  return std::ranges::all_of(normals_around_[v], [&](const Vec3f& normal) { return normal.dot(direction) < kInwards; });
}

}  // namespace osteon::geometry
