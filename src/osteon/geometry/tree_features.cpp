// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/tree_features.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace osteon::geometry {
namespace {

using Eigen::Index;

constexpr float kOutsideFactor = 4.0f;  // added to the length, for each part of it that is outside
constexpr float kMirrorWidth = 0.02f;

Vec3f mean_of(std::span<const Vec3f> points) {
  return std::accumulate(points.begin(), points.end(), Vec3f(Vec3f::Zero())) / static_cast<float>(points.size());
}

Matrix distances_between(std::span<const Vec3f> joints) {
  const auto n = static_cast<Index>(joints.size());
  Matrix out(n, n);
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j) out(i, j) = (joints[static_cast<std::size_t>(i)] - joints[static_cast<std::size_t>(j)]).norm();
  return out;
}

// Steps between all joints along the spanning tree that is cheapest by `cost` (J,J): Prim's algorithm, every joint that joins is one step
// farther from everything than the joint that it joins at.
Matrix steps_in_tree(const Matrix& cost) {
  const Index n = cost.rows();
  Matrix steps = Matrix::Zero(n, n);
  std::vector<Index> inside{0}, nearest(static_cast<std::size_t>(n), 0);
  std::vector<bool> is_inside(static_cast<std::size_t>(n), false);
  is_inside[0] = true;
  while (static_cast<Index>(inside.size()) < n) {
    Index next = -1;
    for (Index j = 0; j < n; ++j)
      if (!is_inside[static_cast<std::size_t>(j)] &&
          (next < 0 || cost(j, nearest[static_cast<std::size_t>(j)]) < cost(next, nearest[static_cast<std::size_t>(next)])))
        next = j;
    const Index at = nearest[static_cast<std::size_t>(next)];
    for (const Index j : inside) steps(next, j) = steps(j, next) = steps(at, j) + 1.0f;
    inside.push_back(next);
    is_inside[static_cast<std::size_t>(next)] = true;
    for (Index j = 0; j < n; ++j)
      if (cost(j, next) < cost(j, nearest[static_cast<std::size_t>(j)])) nearest[static_cast<std::size_t>(j)] = next;
  }
  return steps;
}

// The share of the joints in the largest part that is left of the tree without joint i: of each neighbour's side, whoever is nearer to it.
float largest_part_without(Index i, const Matrix& steps) {
  Index largest = 0;
  for (Index k = 0; k < steps.rows(); ++k)
    if (steps(i, k) == 1.0f) largest = std::max(largest, (steps.row(k).array() < steps.row(i).array()).count());
  return static_cast<float>(largest) / static_cast<float>(steps.rows());
}

// How many other joints are nearer to i than j is; i itself is never one of them.
float rank_of(Index j, Index i, const Matrix& distance) {
  return static_cast<float>(std::max<Index>((distance.row(i).array() < distance(i, j)).count() - 1, 0));
}

float nearer_to_both(Index i, Index j, const Matrix& distance) {
  return static_cast<float>((distance.row(i).cwiseMax(distance.row(j)).array() < distance(i, j)).count());
}

// The vertices that are nearest to each joint.
struct Territory {
  float share = 0;
  Vec3f way = Vec3f::Zero();
};
struct Territories {
  std::vector<Territory> of;      // (J)
  std::vector<float> clearances;  // (J) distance to the nearest of all vertices
};

Territories territories(std::span<const Vec3f> joints, std::span<const Vec3f> vertices) {
  Territories out{std::vector<Territory>(joints.size()), std::vector<float>(joints.size(), std::numeric_limits<float>::infinity())};
  std::vector<float> counts(joints.size(), 0.0f);
  for (const Vec3f& v : vertices) {
    std::size_t nearest = 0;
    float least = std::numeric_limits<float>::infinity();
    for (std::size_t j = 0; j < joints.size(); ++j) {
      const float squared = (v - joints[j]).squaredNorm();
      out.clearances[j] = std::min(out.clearances[j], squared);
      if (squared < least) {
        least = squared;
        nearest = j;
      }
    }
    counts[nearest] += 1.0f;
    out.of[nearest].way += v - joints[nearest];
  }
  for (std::size_t j = 0; j < joints.size(); ++j) {
    out.clearances[j] = std::sqrt(out.clearances[j]);
    if (counts[j] > 0.0f) out.of[j].way /= counts[j];
    out.of[j].share = counts[j] / static_cast<float>(vertices.size()) * static_cast<float>(joints.size());
  }
  return out;
}

}  // namespace

Matrix inside_shares(std::span<const Vec3f> joints, const VoxelGrid& grid) {
  const auto n = static_cast<Index>(joints.size());
  Matrix out = Matrix::Ones(n, n);
  for (Index i = 0; i < n; ++i)
    for (Index j = i + 1; j < n; ++j)
      out(i, j) = out(j, i) = inside_fraction(grid, {joints[static_cast<std::size_t>(i)], joints[static_cast<std::size_t>(j)]});
  return out;
}

TreeFeatures tree_features(const JointSurroundings& at) {
  const auto n = static_cast<Index>(at.joints.size());
  assert(n > 0 && !at.vertices.empty() && at.images.size() == at.joints.size() && at.inside.rows() == n && at.inside.cols() == n);
  const Matrix distance = distances_between(at.joints);
  const Matrix outside = distance.cwiseProduct((1.0f - at.inside.array()).matrix());
  const Matrix steps = steps_in_tree(distance + kOutsideFactor * outside);
  const Territories territory = territories(at.joints, at.vertices);
  const Vec3f middle = mean_of(at.vertices);
  std::vector<float> to_nearest(at.joints.size(), 0.0f);
  for (Index i = 0; i < n; ++i) {
    float least = std::numeric_limits<float>::infinity();
    for (Index j = 0; j < n; ++j)
      if (j != i) least = std::min(least, distance(i, j));
    to_nearest[static_cast<std::size_t>(i)] = n > 1 ? std::max(least, 1e-3f) : 1.0f;
  }

  TreeFeatures out{Matrix(n, kTreeJointFeatures), Matrix(n * n, kTreePairFeatures)};
  for (Index i = 0; i < n; ++i) {
    const auto j = static_cast<std::size_t>(i);
    const Vec3f &p = at.joints[j], &way = territory.of[j].way;
    const float degree = static_cast<float>((steps.row(i).array() == 1.0f).count());
    out.joints.row(i) << p.transpose(), (p - at.images[j]).norm(), territory.clearances[j], territory.of[j].share, way.transpose(),
        to_nearest[j], distance.row(i).mean(), (p - middle).norm(), std::log(static_cast<float>(n)), degree, largest_part_without(i, steps),
        steps.row(i).maxCoeff() / std::max(1.0f, steps.maxCoeff()), p.y() - middle.y();
  }
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j) {
      const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
      const float d = distance(i, j), step = steps(i, j);
      out.pairs.row(i * n + j) << (at.joints[b] - at.joints[a]).transpose(), d, std::log1p(d / to_nearest[a]),
          std::log1p(d / to_nearest[b]), at.inside(i, j), outside(i, j), 1.0f / (1.0f + rank_of(j, i, distance)),
          1.0f / (1.0f + rank_of(i, j, distance)), 1.0f / (1.0f + nearer_to_both(i, j, distance)), 1.0f / std::max(1.0f, step),
          step == 1.0f ? 1.0f : 0.0f, std::exp(-(at.joints[b] - at.images[a]).norm() / kMirrorWidth), i == j ? 1.0f : 0.0f;
    }
  return out;
}

}  // namespace osteon::geometry
