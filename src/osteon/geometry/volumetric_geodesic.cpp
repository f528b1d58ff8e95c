// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/volumetric_geodesic.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <vector>

#include "osteon/base/parallel.h"
#include "osteon/geometry/body_graph.h"
#include "osteon/geometry/body_lines.h"

namespace osteon::geometry {
namespace {

constexpr float kBridge = 0.02f;      // as in geodesic_balls
constexpr float kSampleStep = 0.02f;  // along a bone; two voxels of the 88^3 grid

float parameter_of_nearest(const Segment& s, const Vec3f& p) {
  const Vec3f d = s.b - s.a;
  const float squared = d.squaredNorm();
  return squared > 1e-12f ? std::clamp((p - s.a).dot(d) / squared, 0.0f, 1.0f) : 0.0f;
}

// A point on a bone, and what surrounds it.
struct Sample {
  ClosestPoint surface;
  bool inside;
};

Vec3f point_at(const Segment& bone, float t) { return (1.0f - t) * bone.a + t * bone.b; }

std::vector<Sample> sampled(const Segment& bone, const BodyLines& lines) {
  const int steps = static_cast<int>(std::ceil((bone.b - bone.a).norm() / kSampleStep));
  std::vector<Sample> samples;
  for (int i = 0; i <= steps; ++i) {
    const Vec3f p = point_at(bone, steps > 0 ? static_cast<float>(i) / static_cast<float>(steps) : 0.0f);
    samples.push_back({lines.surface().closest_point(p), lines.is_inside(p)});
  }
  return samples;
}

void start_at_nearest_faces(const TriangleMesh& mesh, const std::vector<Sample>& samples, std::vector<float>& start) {
  for (const Sample& s : samples)
    for (VertexId corner : mesh.faces[s.surface.face]) {
      float& at_corner = start[index(corner)];
      at_corner = std::min(at_corner, s.surface.distance + (mesh.positions[corner] - s.surface.position).norm());
    }
}

void start_at_visible_vertices(const TriangleMesh& mesh, const BodyLines& lines, const Segment& bone, const std::vector<Sample>& samples,
                               std::vector<float>& start) {
  for (VertexId v : mesh.positions.ids()) {
    const float t = parameter_of_nearest(bone, mesh.positions[v]);
    const Vec3f from = point_at(bone, t);
    const Sample& beside = samples[static_cast<std::size_t>(std::lround(t * static_cast<float>(samples.size() - 1)))];
    if (beside.inside && lines.sees(from, v)) start[index(v)] = (mesh.positions[v] - from).norm();
  }
}

// (V)
std::vector<float> distances_to(const Segment& bone, const TriangleMesh& mesh, const BodyLines& lines, const SurfaceGraph& body) {
  const std::vector<Sample> samples = sampled(bone, lines);
  std::vector<float> start(mesh.positions.size(), std::numeric_limits<float>::infinity());
  start_at_nearest_faces(mesh, samples, start);
  start_at_visible_vertices(mesh, lines, bone, samples, start);
  return shortest_paths(body, std::move(start));
}

}  // namespace

Matrix volumetric_geodesic_distance(const TriangleMesh& mesh, const VoxelGrid& grid, std::span<const Segment> bones) {
  assert(!mesh.faces.empty());
  const BodyLines lines(mesh, grid);
  const SurfaceGraph body = body_graph(mesh, lines, kBridge);
  Matrix distances(mesh.positions.size(), bones.size());
  parallel_for(bones.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      const std::vector<float> column = distances_to(bones[b], mesh, lines, body);
      distances.col(static_cast<Eigen::Index>(b)) =
          Eigen::Map<const Eigen::VectorXf>(column.data(), static_cast<Eigen::Index>(column.size()));
    }
  });
  return distances;
}

Matrix straight_distance(const TriangleMesh& mesh, std::span<const Segment> bones) {
  Matrix distances(mesh.positions.size(), bones.size());
  for (VertexId v : mesh.positions.ids())
    for (std::size_t b = 0; b < bones.size(); ++b) {
      const Vec3f& p = mesh.positions[v];
      distances(static_cast<Eigen::Index>(v), static_cast<Eigen::Index>(b)) =
          (p - point_at(bones[b], parameter_of_nearest(bones[b], p))).norm();
    }
  return distances;
}

}  // namespace osteon::geometry
