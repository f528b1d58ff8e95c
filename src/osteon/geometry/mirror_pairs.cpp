// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/mirror_pairs.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "osteon/base/parallel.h"

namespace osteon::geometry {
namespace {

constexpr float kTolerance = 1e-4f;
constexpr float kReaches[] = {5e-3f, 5e-4f, kTolerance};  // of the rounds in which the plane is fitted
constexpr std::size_t kSamples = 4096;                    // vertices to fit it to
constexpr float kNearlyX = 0.9999f;                       // of the fitted normal: then x = 0 is tried, too
constexpr float kRounding = 1e-6f;
constexpr std::size_t kGrain = 256;
// More comparisons are not worth it: beside something far away (a stray vertex) the whole character may lie in a few cells.
constexpr std::size_t kMostComparisons = 100'000'000;

// Vertices by the cell that they lie in.
class Cells {
 public:
  Cells(const PerVertex<Vec3f>& positions, float size) : size_(size) {
    for (VertexId v : positions.ids()) items_.emplace_back(key(cell(positions[v])), v);
    std::ranges::sort(items_);
  }

  // About how many vertices are visited in all if every vertex looks around itself.
  std::size_t comparisons() const {
    std::size_t sum = 0;
    for (std::size_t begin = 0, end = 0; begin < items_.size(); begin = end) {
      while (end < items_.size() && items_[end].first == items_[begin].first) ++end;
      sum += (end - begin) * (end - begin);
    }
    return sum;
  }

  // Calls visit(v) for every vertex in the cells within `reach` of p, and for some more.
  template <class Visit>
  void around(const Vec3f& p, float reach, const Visit& visit) const {
    const Eigen::Array3i low = cell(p - Vec3f::Constant(reach)), high = cell(p + Vec3f::Constant(reach));
    for (int x = low.x(); x <= high.x(); ++x)
      for (int y = low.y(); y <= high.y(); ++y)
        for (int z = low.z(); z <= high.z(); ++z) {
          const std::uint64_t wanted = key({x, y, z});
          for (auto i = std::ranges::lower_bound(items_, wanted, {}, &Item::first); i != items_.end() && i->first == wanted; ++i)
            visit(i->second);
        }
  }

 private:
  using Item = std::pair<std::uint64_t, VertexId>;

  Eigen::Array3i cell(const Vec3f& p) const { return (p / size_).array().floor().cast<int>(); }
  static std::uint64_t key(const Eigen::Array3i& at) {
    constexpr int kMiddle = 1 << 20;
    const auto part = [](int i) { return static_cast<std::uint64_t>(i + kMiddle); };
    return part(at.x()) << 42 | part(at.y()) << 21 | part(at.z());
  }

  float size_;
  std::vector<Item> items_;
};

using Partners = PerVertex<std::optional<VertexId>>;

class Matcher {
 public:
  explicit Matcher(const TriangleMesh& mesh) : positions_(mesh.positions), normals_(vertex_normals(mesh)) {}

  // Of every stride-th vertex; none where the vertices lie too close together to look.
  Partners partners(const Plane& plane, float reach, std::size_t stride) const {
    const Cells cells(positions_, 4.0f * reach);
    Partners out(positions_.size());
    if (cells.comparisons() / stride > kMostComparisons) return out;
    parallel_for((positions_.size() + stride - 1) / stride, kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const auto v = static_cast<VertexId>(i * stride);
        out[v] = partner(v, plane, reach, cells);
      }
    });
    return out;
  }

 private:
  std::optional<VertexId> partner(VertexId v, const Plane& plane, float reach, const Cells& cells) const {
    const Vec3f image = plane.mirror(positions_[v]);
    const Vec3f normal = normals_[v] - 2.0f * plane.normal.dot(normals_[v]) * plane.normal;
    std::optional<VertexId> best;
    float least = std::numeric_limits<float>::infinity();
    cells.around(image, reach, [&](VertexId w) {
      const float distance = (positions_[w] - image).norm();
      if (distance > reach) return;
      const float cost = distance / reach + (normals_[w] - normal).norm();
      if (cost < least || (cost == least && w < *best)) {
        least = cost;
        best = w;
      }
    });
    return best;
  }

  const PerVertex<Vec3f>& positions_;
  PerVertex<Vec3f> normals_;
};

// Empty when fewer than half of the `samples` have partners.
std::optional<Plane> fitted(const PerVertex<Vec3f>& positions, const Partners& partners, std::size_t samples, const Plane& before) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  std::size_t count = 0;
  for (VertexId v : partners.ids())
    if (partners[v]) {
      middle += 0.5 * (positions[v] + positions[*partners[v]]).cast<double>();
      ++count;
    }
  if (2 * count < samples) return std::nullopt;
  middle /= static_cast<double>(count);
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
  for (VertexId v : partners.ids())
    if (partners[v]) {
      const Eigen::Vector3d p = positions[v].cast<double>() - middle, q = positions[*partners[v]].cast<double>() - middle;
      products += p * q.transpose() + q * p.transpose();
    }
  Eigen::Vector3d normal = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(products).eigenvectors().col(0);
  if (normal.dot(before.normal.cast<double>()) < 0.0) normal = -normal;
  return Plane{normal.cast<float>(), static_cast<float>(normal.dot(middle))};
}

// Empty unless everybody has a partner, and is that one's partner.
std::optional<MirrorPairs> complete(const Plane& plane, const Partners& partners) {
  MirrorPairs out{plane, {}};
  out.partner.reserve(partners.size());
  for (VertexId v : partners.ids()) {
    if (!partners[v] || partners[*partners[v]] != v) return std::nullopt;
    out.partner.push_back(*partners[v]);
  }
  return out;
}

float largest_miss(const MirrorPairs& pairs, const PerVertex<Vec3f>& positions) {
  float largest = 0.0f;
  for (VertexId v : positions.ids()) largest = std::max(largest, (pairs.plane.mirror(positions[v]) - positions[pairs.partner[v]]).norm());
  return largest;
}

}  // namespace

std::optional<MirrorPairs> mirror_pairs(const TriangleMesh& mesh, const Plane& near) {
  const Matcher matcher(mesh);
  const std::size_t stride = 1 + mesh.positions.size() / kSamples, samples = (mesh.positions.size() + stride - 1) / stride;
  Plane plane = near;
  for (float reach : kReaches) {
    const auto better = fitted(mesh.positions, matcher.partners(plane, reach, stride), samples, plane);
    if (!better) return std::nullopt;
    plane = *better;
  }
  auto pairs = complete(plane, matcher.partners(plane, kTolerance, 1));
  if (!pairs || std::abs(plane.normal.x()) < kNearlyX) return pairs;
  const MirrorPairs straight{{Vec3f::UnitX(), 0.0f}, pairs->partner};
  return largest_miss(straight, mesh.positions) <= largest_miss(*pairs, mesh.positions) + kRounding ? straight : pairs;
}

}  // namespace osteon::geometry
