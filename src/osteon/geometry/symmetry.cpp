// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/symmetry.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <vector>

#include "osteon/base/parallel.h"
#include "osteon/geometry/bvh.h"

namespace osteon::geometry {
namespace {

constexpr std::size_t kFewSamples = 64, kManySamples = 320;  // of the surface: to choose among candidates, and to refine and judge the best
constexpr std::size_t kFinalists = 2;
constexpr int kFirstSteps = 4, kLastSteps = 5;
constexpr float kOutlier = 3.0f;          // times the median distance: hair, weapons, ... do not tilt the plane
constexpr float kAlike = 0.6f;            // principal moments with a larger ratio leave the direction open
constexpr float kNearEqualFactor = 1.5f;  // scores up to this times the best, plus ...
constexpr float kNearEqualOffset = 0.0015f;
constexpr float kSameDirection = 0.985f;  // cosine of 10 degrees

struct Candidate {
  Plane plane;
  float score = std::numeric_limits<float>::infinity();  // mean distance of mirrored samples, in diagonals
};

// The surface's first and second moments: over a triangle of area A, the integral of x x^T is A / 12 (sum of the corners' + 9 times the
// centre's).
struct Moments {
  Vec3f center = Vec3f::Zero();
  Eigen::Matrix3f covariance = Eigen::Matrix3f::Zero();
};

Moments moments(const TriangleMesh& mesh) {
  double area = 0.0;
  Eigen::Vector3d first = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (FaceId f : mesh.faces.ids()) {
    const double a = 0.5 * static_cast<double>(area_vector(mesh, f).norm());
    Eigen::Vector3d middle = Eigen::Vector3d::Zero();
    Eigen::Matrix3d corners = Eigen::Matrix3d::Zero();
    for (VertexId v : mesh.faces[f]) {
      const Eigen::Vector3d p = mesh.positions[v].cast<double>();
      middle += p / 3.0;
      corners += p * p.transpose();
    }
    area += a;
    first += a * middle;
    second += a / 12.0 * (corners + 9.0 * middle * middle.transpose());
  }
  const Eigen::Vector3d center = first / area;
  return {center.cast<float>(), (second / area - center * center.transpose()).cast<float>()};
}

// Points spread evenly over the area: equal steps through the faces, and within a face the sequence of multiples of the plastic number's
// powers (Roberts, "The unreasonable effectiveness of quasirandom sequences", 2018). Every k-th of them is spread evenly, too.
std::vector<Vec3f> surface_samples(const TriangleMesh& mesh, std::size_t count) {
  std::vector<double> ends;
  double area = 0.0;
  for (FaceId f : mesh.faces.ids()) ends.push_back(area += static_cast<double>(area_vector(mesh, f).norm()));
  std::vector<Vec3f> samples;
  for (std::size_t i = 0; i < count; ++i) {
    const double at = (static_cast<double>(i) + 0.5) / static_cast<double>(count) * area;
    const auto found = static_cast<std::size_t>(std::ranges::lower_bound(ends, at) - ends.begin());
    const auto& [a, b, c] = mesh.faces[static_cast<FaceId>(std::min(found, ends.size() - 1))];
    double whole;
    auto s = static_cast<float>(std::modf(0.5 + 0.7548776662466927 * static_cast<double>(i), &whole));
    auto t = static_cast<float>(std::modf(0.5 + 0.5698402909980532 * static_cast<double>(i), &whole));
    if (s + t > 1.0f) s = 1.0f - s, t = 1.0f - t;
    samples.push_back((1.0f - s - t) * mesh.positions[a] + s * mesh.positions[b] + t * mesh.positions[c]);
  }
  return samples;
}

// Directions in the plane of u and v, 22.5 degrees apart.
void add_turns(const Vec3f& u, const Vec3f& v, std::vector<Vec3f>& normals) {
  for (int k = 1; k < 8; ++k) {
    const float angle = std::numbers::pi_v<float> * static_cast<float>(k) / 8.0f;
    normals.push_back(std::cos(angle) * u + std::sin(angle) * v);
  }
}

std::vector<Vec3f> candidate_normals(const Eigen::Matrix3f& covariance) {
  std::vector<Vec3f> normals{Vec3f::UnitX(), Vec3f::UnitZ(), Vec3f::UnitY()};
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> solver(covariance);
  const Eigen::Matrix3f axes = solver.eigenvectors();
  const Vec3f spread = solver.eigenvalues();  // ascending
  for (int k = 0; k < 3; ++k) normals.push_back(axes.col(k));
  const bool low_alike = spread[0] > kAlike * spread[1], high_alike = spread[1] > kAlike * spread[2];
  if (low_alike) add_turns(axes.col(0), axes.col(1), normals);
  if (high_alike) add_turns(axes.col(1), axes.col(2), normals);
  if (low_alike && high_alike) {
    add_turns(axes.col(0), axes.col(2), normals);
    for (int k = 0; k < 4; ++k)
      normals.push_back((axes.col(0) + (k & 1 ? 1.0f : -1.0f) * axes.col(1) + (k & 2 ? 1.0f : -1.0f) * axes.col(2)).normalized());
  }
  return normals;
}

class Mirror {
 public:
  Mirror(const TriangleMesh& mesh, const Vec3f& center, std::vector<Vec3f> samples)
      : mesh_(mesh), surface_(mesh), center_(center), samples_(std::move(samples)), diagonal_(bounds(mesh).diagonal().norm()) {}

  float score(const Plane& plane, std::size_t stride) const {
    double sum = 0.0;
    std::size_t count = 0;
    for (std::size_t i = 0; i < samples_.size(); i += stride, ++count)
      sum += static_cast<double>(surface_.closest_point(plane.mirror(samples_[i])).distance);
    return static_cast<float>(sum / static_cast<double>(count)) / diagonal_;
  }

  Plane refined(Plane plane, int steps, std::size_t stride) const {
    for (int i = 0; i < steps; ++i) plane = better(plane, stride);
    return plane;
  }

 private:
  // One sample: how far its image is from the surface, and how that changes as the plane turns and shifts.
  struct Equation {
    float distance;
    Vec3f gradient;
  };

  // A step of Gauss and Newton on the distances, over the two turns of the normal (about the centre) and the shift of the plane.
  Plane better(const Plane& plane, std::size_t stride) const {
    const Vec3f u = plane.normal.unitOrthogonal(), v = plane.normal.cross(u);
    std::vector<Equation> equations;
    for (std::size_t i = 0; i < samples_.size(); i += stride) equations.push_back(equation(plane, u, v, samples_[i]));
    const float limit = kOutlier * median_distance(equations);
    Eigen::Matrix3f normal_matrix = Eigen::Matrix3f::Zero();
    Vec3f right = Vec3f::Zero();
    for (const auto& [distance, gradient] : equations) {
      if (distance > limit) continue;
      normal_matrix += gradient * gradient.transpose();
      right -= distance * gradient;
    }
    normal_matrix.diagonal().array() +=
        1e-3f * normal_matrix.trace() + std::numeric_limits<float>::min();  // a sphere leaves turns undetermined
    const Vec3f step = normal_matrix.ldlt().solve(right);
    const float shift_at_center = plane.signed_distance(center_);
    const Vec3f normal = (plane.normal + (step[0] * u + step[1] * v) / diagonal_).normalized();
    return {normal, normal.dot(center_) - shift_at_center + step[2]};
  }

  // Turns are measured by the way of a point one diagonal away, so that all three unknowns are lengths.
  Equation equation(const Plane& plane, const Vec3f& u, const Vec3f& v, const Vec3f& sample) const {
    const Vec3f image = plane.mirror(sample);
    const ClosestPoint nearest = surface_.closest_point(image);
    const Vec3f away = nearest.distance > 1e-4f * diagonal_ ? Vec3f((image - nearest.position) / nearest.distance)
                                                            : area_vector(mesh_, nearest.face).stableNormalized();
    const float height = plane.signed_distance(sample);
    const Vec3f from_center = sample - center_;
    const auto turn = [&](const Vec3f& w) { return -2.0f * away.dot(height * w + w.dot(from_center) * plane.normal) / diagonal_; };
    return {away.dot(image - nearest.position), {turn(u), turn(v), 2.0f * away.dot(plane.normal)}};
  }

  float median_distance(const std::vector<Equation>& equations) const {
    std::vector<float> distances;
    for (const Equation& e : equations) distances.push_back(std::abs(e.distance));
    std::ranges::nth_element(distances, distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2));
    return std::max(distances[distances.size() / 2], 1e-4f * diagonal_);
  }

  const TriangleMesh& mesh_;
  Bvh surface_;
  Vec3f center_;
  std::vector<Vec3f> samples_;
  float diagonal_;
};

// Refines and scores every candidate, best first.
std::vector<Candidate> judged(const Mirror& mirror, std::vector<Candidate> candidates, int steps, std::size_t stride) {
  parallel_for(candidates.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      candidates[i].plane = mirror.refined(candidates[i].plane, steps, stride);
      candidates[i].score = mirror.score(candidates[i].plane, stride);
    }
  });
  std::ranges::stable_sort(candidates, {}, &Candidate::score);
  return candidates;
}

int rank(const Plane& plane) {  // 0: like x = 0, 1: vertical, 2: other
  if (std::abs(plane.normal.x()) > kSameDirection) return 0;
  return std::abs(plane.normal.y()) < std::sqrt(1.0f - kSameDirection * kSameDirection) ? 1 : 2;
}

bool near_equal(float score, float best) { return score <= kNearEqualFactor * best + kNearEqualOffset; }

// The best of each rank as far as they are near the best of all, and then more of the best.
std::vector<Candidate> finalists(const std::vector<Candidate>& sorted) {
  std::vector<Candidate> out;
  for (int r = 0; r < 3; ++r)
    if (const auto first = std::ranges::find(sorted, r, [](const Candidate& c) { return rank(c.plane); }); first != sorted.end())
      out.push_back(*first);
  for (const Candidate& c : sorted) {
    const bool is_new =
        std::ranges::none_of(out, [&](const Candidate& o) { return std::abs(o.plane.normal.dot(c.plane.normal)) > kSameDirection; });
    if (out.size() < 3 + kFinalists && is_new) out.push_back(c);
  }
  return out;
}

// The plane with its normal turned exactly to the axis that it nearly has, if it is as good.
Candidate snapped(const Mirror& mirror, const Vec3f& center, const Candidate& found) {
  Eigen::Index axis = 0;
  found.plane.normal.cwiseAbs().maxCoeff(&axis);
  if (std::abs(found.plane.normal[axis]) < kSameDirection) return found;
  const Vec3f normal = Vec3f::Unit(axis);
  // The point of the found plane nearest to the centre stays on it.
  const Vec3f on_plane = center - found.plane.signed_distance(center) * found.plane.normal;
  const Candidate straight{{normal, normal.dot(on_plane)}, mirror.score({normal, normal.dot(on_plane)}, 1)};
  return straight.score <= 1.1f * found.score + 2e-4f ? straight : found;
}

Plane with_positive_normal(Plane plane) {
  Eigen::Index axis = 0;
  plane.normal.cwiseAbs().maxCoeff(&axis);
  return plane.normal[axis] < 0.0f ? Plane{-plane.normal, -plane.offset} : plane;
}

}  // namespace

std::optional<Plane> symmetry_plane(const TriangleMesh& mesh, const SymmetryOptions& options) {
  if (!(surface_area(mesh) > 0.0)) return std::nullopt;
  const Moments shape = moments(mesh);
  const Mirror mirror(mesh, shape.center, surface_samples(mesh, kManySamples));
  std::vector<Candidate> candidates;
  for (const Vec3f& normal : candidate_normals(shape.covariance)) candidates.push_back({{normal, normal.dot(shape.center)}});
  candidates = judged(mirror, std::move(candidates), kFirstSteps, kManySamples / kFewSamples);
  candidates = judged(mirror, finalists(candidates), kLastSteps, 1);
  for (Candidate& c : candidates) c = snapped(mirror, shape.center, c);
  const float best = std::ranges::min(candidates, {}, &Candidate::score).score;
  std::erase_if(candidates, [&](const Candidate& c) { return !near_equal(c.score, best); });
  const Candidate chosen = std::ranges::min(candidates, {}, [](const Candidate& c) { return std::pair(rank(c.plane), c.score); });
  if (!(chosen.score <= options.tolerance)) return std::nullopt;
  return with_positive_normal(chosen.plane);
}

}  // namespace osteon::geometry
