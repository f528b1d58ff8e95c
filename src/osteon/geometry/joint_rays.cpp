// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/joint_rays.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <numeric>

#include "osteon/base/parallel.h"

namespace osteon::geometry {
namespace {

constexpr float kLeastBoneLength = 1e-6f;
constexpr float kMarkedRadius = 0.02f;  // around a hit; longest side = 1
constexpr float kFarFactor = 2.0f;      // times the low percentile: a hit on some other part
constexpr float kLowPercentile = 0.2f;
constexpr std::size_t kLeastMarked = 6;  // vertices of a joint

// Directions of all bones that meet at each joint, its own before those to its children; never empty.
std::vector<std::vector<Vec3f>> bone_axes(std::span<const Vec3f> joints, std::span<const int> parents) {
  assert(joints.size() == parents.size());
  std::vector<std::vector<Vec3f>> axes(joints.size());
  for (std::size_t j = 0; j < joints.size(); ++j) {
    if (parents[j] < 0) continue;
    const auto parent = static_cast<std::size_t>(parents[j]);
    const Vec3f bone = joints[j] - joints[parent];
    if (bone.norm() <= kLeastBoneLength) continue;
    axes[j].push_back(bone.normalized());
    axes[parent].push_back(bone.normalized());
  }
  for (auto& of_joint : axes)
    if (of_joint.empty()) of_joint.push_back(Vec3f::UnitY());
  return axes;
}

// Some unit vector perpendicular to `axis`, the same for the same axis: from the coordinate axis that is least along it.
Vec3f perpendicular(const Vec3f& axis) {
  Eigen::Index least = 0;
  axis.cwiseAbs().minCoeff(&least);
  return axis.cross(Vec3f::Unit(least)).normalized();
}

SurfaceHits corners_of_nearest_face(const TriangleMesh& mesh, const Bvh& surface, const Vec3f& joint) {
  SurfaceHits out;
  for (VertexId corner : mesh.faces[surface.closest_point(joint).face]) {
    out.points.push_back(mesh.positions[corner]);
    out.distances.push_back((mesh.positions[corner] - joint).norm());
  }
  return out;
}

// Linear between ranks, as numpy.percentile.
float quantile(std::vector<float> values, float q) {
  std::ranges::sort(values);
  const float rank = q * static_cast<float>(values.size() - 1);
  const auto below = static_cast<std::size_t>(rank);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  return values[below] + (rank - static_cast<float>(below)) * (values[above] - values[below]);
}

// Points around the joint that count as its own surface.
std::vector<Vec3f> near_hits(const TriangleMesh& mesh, const Bvh& surface, const Vec3f& joint, const std::vector<Vec3f>& axes) {
  std::vector<Vec3f> kept;
  for (const Vec3f& axis : axes) {
    const SurfaceHits hits = perpendicular_hits(mesh, surface, joint, axis);
    const float limit = kFarFactor * quantile(hits.distances, kLowPercentile);
    for (std::size_t i = 0; i < hits.points.size(); ++i)
      if (hits.distances[i] < limit || hits.distances[i] == 0.0f) kept.push_back(hits.points[i]);
  }
  return kept;
}

std::vector<std::size_t> vertices_near(const TriangleMesh& mesh, const std::vector<Vec3f>& points) {
  std::vector<std::size_t> out;
  for (VertexId v : mesh.positions.ids())
    if (std::ranges::any_of(points, [&](const Vec3f& p) { return (p - mesh.positions[v]).norm() <= kMarkedRadius; }))
      out.push_back(index(v));
  return out;
}

std::vector<std::size_t> nearest_vertices(const TriangleMesh& mesh, const Vec3f& joint, std::size_t count) {
  std::vector<std::size_t> order(mesh.positions.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  count = std::min(count, order.size());
  const auto key = [&](std::size_t v) { return std::pair((mesh.positions.raw()[v] - joint).squaredNorm(), v); };
  std::ranges::partial_sort(order, order.begin() + static_cast<std::ptrdiff_t>(count), {}, key);
  order.resize(count);
  return order;
}

}  // namespace

SurfaceHits perpendicular_hits(const TriangleMesh& mesh, const Bvh& surface, const Vec3f& joint, const Vec3f& axis) {
  const Vec3f u = perpendicular(axis), v = axis.cross(u);
  SurfaceHits out;
  for (int k = 0; k < kJointRays; ++k) {
    const float angle = 2.0f * std::numbers::pi_v<float> * static_cast<float>(k) / static_cast<float>(kJointRays);
    const Vec3f direction = std::cos(angle) * u + std::sin(angle) * v;
    if (const auto hit = surface.first_hit(joint, direction)) {
      out.points.push_back(joint + hit->distance * direction);
      out.distances.push_back(hit->distance);
    }
  }
  return out.points.empty() ? corners_of_nearest_face(mesh, surface, joint) : out;
}

std::vector<float> joint_tolerances(const TriangleMesh& mesh, std::span<const Vec3f> joints, std::span<const int> parents) {
  const Bvh surface(mesh);
  const auto axes = bone_axes(joints, parents);
  std::vector<float> means;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    std::vector<float> lengths;
    for (const Vec3f& axis : axes[j]) {
      const SurfaceHits hits = perpendicular_hits(mesh, surface, joints[j], axis);
      lengths.insert(lengths.end(), hits.distances.begin(), hits.distances.end());
    }
    means.push_back(std::accumulate(lengths.begin(), lengths.end(), 0.0f) / static_cast<float>(lengths.size()));
  }
  return means;
}

std::vector<std::uint8_t> attention_labels(const TriangleMesh& mesh, std::span<const Vec3f> joints, std::span<const int> parents) {
  const Bvh surface(mesh);
  const auto axes = bone_axes(joints, parents);
  std::vector<std::vector<std::size_t>> marked(joints.size());
  parallel_for(joints.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j) {
      marked[j] = vertices_near(mesh, near_hits(mesh, surface, joints[j], axes[j]));
      if (marked[j].size() < kLeastMarked)
        for (std::size_t v : nearest_vertices(mesh, joints[j], kLeastMarked)) marked[j].push_back(v);
    }
  });
  std::vector<std::uint8_t> labels(mesh.positions.size(), 0);
  for (const auto& of_joint : marked)
    for (std::size_t v : of_joint) labels[v] = 1;
  return labels;
}

}  // namespace osteon::geometry
