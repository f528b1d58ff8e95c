// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/volumetric_geodesic.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "osteon/base/parallel.h"
#include "osteon/geometry/bvh.h"
#include "osteon/geometry/surface_graph.h"

namespace osteon::geometry {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kUnreachable = 1.0f;  // added to the Euclidean distance: the longest side of the character
constexpr float kBridge = 0.02f;      // as in geodesic_balls
constexpr float kSampleStep = 0.02f;  // along a bone; two voxels of the 88^3 grid
constexpr float kArrival = -0.3f;     // least cosine of ray and normal at the vertex; below 0 for vertices in folds
constexpr float kPast = 1e-5f;        // how far beyond a hit the ray goes on
constexpr int kMostCrossings = 32;    // of one ray, more than the layers of any clothing

float parameter_of_nearest(const Segment& s, const Vec3f& p) {
  const Vec3f d = s.b - s.a;
  const float squared = d.squaredNorm();
  return squared > 1e-12f ? std::clamp((p - s.a).dot(d) / squared, 0.0f, 1.0f) : 0.0f;
}

// Solid angle of a face seen from p: van Oosterom and Strackee, "The solid angle of a plane triangle", 1983, equation 8.
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

// A point on a bone, and what surrounds it.
struct Sample {
  ClosestPoint surface;
  bool inside;
};

class BodyDistance {
 public:
  BodyDistance(const TriangleMesh& mesh, const VoxelGrid& grid)
      : mesh_(mesh), grid_(grid), surface_(mesh), graph_(surface_graph(mesh, kBridge)), normals_(mesh.positions.size(), Vec3f::Zero()) {
    for (FaceId f : mesh.faces.ids())
      for (VertexId v : mesh.faces[f]) normals_[v] += area_vector(mesh, f);
    for (Vec3f& n : normals_) n.stableNormalize();  // stays zero where faces cancel out: such a vertex is seen from either side
  }

  std::vector<float> to(const Segment& bone) const {
    const std::vector<Sample> samples = sampled(bone);
    std::vector<float> start(mesh_.positions.size(), kInfinity);
    start_at_nearest_faces(samples, start);
    start_at_visible_vertices(bone, samples, start);
    std::vector<float> distances = shortest_paths(graph_, std::move(start));
    for (VertexId v : mesh_.positions.ids())
      if (!std::isfinite(distances[osteon::index(v)])) distances[osteon::index(v)] = kUnreachable + euclidean(bone, v);
    return distances;
  }

 private:
  static Vec3f point_at(const Segment& bone, float t) { return (1.0f - t) * bone.a + t * bone.b; }

  float euclidean(const Segment& bone, VertexId v) const {
    const Vec3f& p = mesh_.positions[v];
    return (p - point_at(bone, parameter_of_nearest(bone, p))).norm();
  }

  std::vector<Sample> sampled(const Segment& bone) const {
    const int steps = static_cast<int>(std::ceil((bone.b - bone.a).norm() / kSampleStep));
    std::vector<Sample> samples;
    for (int i = 0; i <= steps; ++i) {
      const Vec3f p = point_at(bone, steps > 0 ? static_cast<float>(i) / static_cast<float>(steps) : 0.0f);
      samples.push_back({surface_.closest_point(p), is_inside(p)});
    }
    return samples;
  }

  // Voxels that the surface touches lie on both of its sides: there the generalised winding number decides.
  bool is_inside(const Vec3f& p) const {
    const Voxel voxel = grid_.at(p);
    return voxel == Voxel::Interior || (voxel == Voxel::Surface && winding_number(mesh_, p) >= 0.5);
  }

  void start_at_nearest_faces(const std::vector<Sample>& samples, std::vector<float>& start) const {
    for (const Sample& s : samples)
      for (VertexId corner : mesh_.faces[s.surface.face]) {
        float& at_corner = start[osteon::index(corner)];
        at_corner = std::min(at_corner, s.surface.distance + (mesh_.positions[corner] - s.surface.position).norm());
      }
  }

  void start_at_visible_vertices(const Segment& bone, const std::vector<Sample>& samples, std::vector<float>& start) const {
    for (VertexId v : mesh_.positions.ids()) {
      const Vec3f& p = mesh_.positions[v];
      const float t = parameter_of_nearest(bone, p);
      const Sample& near_sample = samples[static_cast<std::size_t>(std::lround(t * static_cast<float>(samples.size() - 1)))];
      const Vec3f from = point_at(bone, t);
      if (near_sample.inside && is_visible(from, v)) start[osteon::index(v)] = (p - from).norm();
    }
  }

  // A cheap look ahead of the rays, which also closes holes: a voxel Outside holds nothing of the body.
  bool passes_outside(const Vec3f& from, const Vec3f& line) const {
    const int steps = static_cast<int>(line.norm() / grid_.cell);
    for (int i = 1; i < steps; ++i)
      if (grid_.at(from + static_cast<float>(i) / static_cast<float>(steps) * line) == Voxel::Outside) return true;
    return false;
  }

  bool is_corner(VertexId v, FaceId f) const { return std::ranges::find(mesh_.faces[f], v) != mesh_.faces[f].end(); }

  // Whether the line from a point inside to v stays inside. Where parts overlap the line is in several at once: it is outside when it has
  // left as many as it was in.
  bool is_visible(const Vec3f& from, VertexId v) const {
    const Vec3f line = mesh_.positions[v] - from;
    const float length = line.norm();
    if (length <= kPast) return true;
    const Vec3f direction = line / length;
    if (normals_[v].dot(direction) < kArrival || passes_outside(from, line)) return false;
    float travelled = 0.0f;
    int parts = 1;
    for (int crossing = 0; crossing < kMostCrossings; ++crossing) {
      const auto hit = surface_.first_hit(from + travelled * direction, direction, length - travelled);
      if (!hit || is_corner(v, hit->face)) return true;
      parts += area_vector(mesh_, hit->face).dot(direction) > 0.0f ? -1 : 1;
      travelled += hit->distance + kPast;
      if (travelled >= length) return true;
      if (parts == 0) return false;
    }
    return false;
  }

  const TriangleMesh& mesh_;
  const VoxelGrid& grid_;
  Bvh surface_;
  SurfaceGraph graph_;
  PerVertex<Vec3f> normals_;
};

}  // namespace

Matrix volumetric_geodesic_distance(const TriangleMesh& mesh, const VoxelGrid& grid, std::span<const Segment> bones) {
  const BodyDistance body(mesh, grid);
  Matrix distances(mesh.positions.size(), bones.size());
  parallel_for(bones.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t b = begin; b < end; ++b) {
      const std::vector<float> column = body.to(bones[b]);
      distances.col(static_cast<Eigen::Index>(b)) =
          Eigen::Map<const Eigen::VectorXf>(column.data(), static_cast<Eigen::Index>(column.size()));
    }
  });
  return distances;
}

}  // namespace osteon::geometry
