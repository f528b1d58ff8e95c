// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/rignet_features.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "osteon/base/parallel.h"

namespace osteon::geometry {
namespace {

constexpr std::size_t kGrain = 256;

Eigen::Index at(std::size_t i) { return static_cast<Eigen::Index>(i); }

Eigen::RowVector<float, kBoneFeatures> bone_features(const Segment& bone, float distance, bool is_leaf) {
  Eigen::RowVector<float, kBoneFeatures> out;
  out << bone.a.transpose(), bone.b.transpose(), proximity(distance), is_leaf ? 1.0f : 0.0f;
  return out;
}

}  // namespace

Matrix pair_features(std::span<const Vec3f> joints, const VoxelGrid& grid) {
  const std::size_t n = joints.size();
  Matrix out(at(n > 0 ? n * (n - 1) / 2 : 0), kPairFeatures);
  Eigen::Index row = 0;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j) {
      const Segment bone{joints[i], joints[j]};
      out.row(row++) << bone.a.transpose(), bone.b.transpose(), (bone.b - bone.a).norm(), inside_fraction(grid, bone);
    }
  return out;
}

Matrix one_bone_per_joint(const Matrix& distances, std::span<const int> starts) {
  assert(distances.cols() == at(starts.size()));
  Matrix out = distances;
  parallel_for(static_cast<std::size_t>(out.rows()), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      std::vector<int> nearest(static_cast<std::size_t>(std::ranges::max(starts)) + 1, -1);  // of each joint
      for (int b = 0; b < out.cols(); ++b) {
        int& best = nearest[static_cast<std::size_t>(starts[static_cast<std::size_t>(b)])];
        const bool is_nearer = best < 0 || distances(at(v), b) < distances(at(v), best);
        if (!is_nearer || best >= 0) out(at(v), is_nearer ? best : b) = std::numeric_limits<float>::infinity();
        if (is_nearer) best = b;
      }
    }
  });
  return out;
}

float proximity(float distance) { return 0.1f / (distance + 0.02f); }

float distance_of_proximity(float proximity) { return 0.1f / proximity - 0.02f; }

IndexMatrix nearest_bones(const Matrix& distances, int k) {
  IndexMatrix nearest = IndexMatrix::Constant(distances.rows(), k, -1);
  parallel_for(static_cast<std::size_t>(distances.rows()), kGrain, [&](std::size_t begin, std::size_t end) {
    std::vector<int> order;
    for (std::size_t v = begin; v < end; ++v) {
      order.clear();
      for (int b = 0; b < distances.cols(); ++b)
        if (std::isfinite(distances(at(v), b))) order.push_back(b);
      const auto kept = std::min(order.size(), static_cast<std::size_t>(k));
      std::ranges::partial_sort(order, order.begin() + static_cast<std::ptrdiff_t>(kept), {},
                                [&](int b) { return std::pair(distances(at(v), b), b); });
      for (std::size_t i = 0; i < kept; ++i) nearest(at(v), at(i)) = order[i];
    }
  });
  return nearest;
}

SkinInputs skin_inputs(std::span<const Vec3f> positions, std::span<const Segment> bones, std::span<const std::uint8_t> leaf,
                       const Matrix& distances, int k) {
  assert(!bones.empty() && leaf.size() == bones.size() && k > 0);
  assert(distances.rows() == at(positions.size()) && distances.cols() == at(bones.size()));
  SkinInputs out;
  out.features.resize(at(positions.size()), 3 + k * kBoneFeatures);
  out.nearest = nearest_bones(distances, k);
  parallel_for(positions.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      assert(out.nearest(at(v), 0) >= 0);
      out.features.row(at(v)).head<3>() = positions[v].transpose();
      for (int slot = 0; slot < k; ++slot) {
        const int bone = out.nearest(at(v), out.nearest(at(v), slot) >= 0 ? slot : 0);
        out.features.row(at(v)).segment<kBoneFeatures>(3 + slot * kBoneFeatures) =
            bone_features(bones[static_cast<std::size_t>(bone)], distances(at(v), bone), leaf[static_cast<std::size_t>(bone)] != 0);
      }
    }
  });
  return out;
}

SkinTargets skin_targets(const Matrix& joint_weights, std::span<const int> starts, const IndexMatrix& nearest) {
  assert(joint_weights.rows() == nearest.rows());
  SkinTargets out;
  out.weights.setZero(nearest.rows(), nearest.cols());
  for (Eigen::Index v = 0; v < nearest.rows(); ++v) {
    std::vector<int> used;  // joints whose weight a nearer bone has taken
    for (Eigen::Index slot = 0; slot < nearest.cols(); ++slot) {
      if (nearest(v, slot) < 0) continue;
      const int joint = starts[static_cast<std::size_t>(nearest(v, slot))];
      if (std::ranges::find(used, joint) != used.end()) continue;
      used.push_back(joint);
      out.weights(v, slot) = joint_weights(v, joint);
    }
    out.covered.push_back(out.weights.row(v).sum());
    if (out.covered.back() > 0.0f) out.weights.row(v) /= out.covered.back();
  }
  return out;
}

}  // namespace osteon::geometry
