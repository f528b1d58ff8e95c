// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/bind_features.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "osteon/base/parallel.h"

namespace osteon::geometry {
namespace {

constexpr std::size_t kGrain = 256;
constexpr float kSmall = 0.005f;  // added to lengths before the logarithm, which then ends at -5.3

Eigen::Index at(std::size_t i) { return static_cast<Eigen::Index>(i); }

float log_length(float length) { return std::log(length + kSmall) + 3.0f; }  // 0 at about the radius of a limb

// How two bones hang together.
struct Relation {
  bool is_child, is_parent, is_sibling;  // of the other
};

// Where a joint stands in its tree.
struct Place {
  int parent = -1, children = 0;
  float parent_length = 0.0f;  // of the bone that ends at it
};

class BoneTree {
 public:
  explicit BoneTree(const BoneList& bones) : bones_(bones) {
    joints_.resize(static_cast<std::size_t>(1 + std::max(std::ranges::max(bones.starts), std::ranges::max(bones.ends))));
    for (std::size_t b = 0; b < bones.starts.size(); ++b) {
      if (bones.ends[b] < 0) continue;
      Place& end = joints_[static_cast<std::size_t>(bones.ends[b])];
      end.parent = bones.starts[b];
      end.parent_length = (bones.segments[b].b - bones.segments[b].a).norm();
      ++joints_[static_cast<std::size_t>(bones.starts[b])].children;
    }
  }
  const Place& start_of(std::size_t bone) const { return joints_[static_cast<std::size_t>(bones_.starts[bone])]; }
  Relation of(std::size_t bone, std::size_t other) const {
    const int above = start_of(bone).parent, above_other = start_of(other).parent;
    return {above == bones_.starts[other], above_other == bones_.starts[bone], bone != other && above >= 0 && above == above_other};
  }

 private:
  const BoneList& bones_;
  std::vector<Place> joints_;
};

Vec3f direction_or_zero(const Vec3f& v) {
  const float length = v.norm();
  return length > 1e-6f ? Vec3f(v / length) : Vec3f(Vec3f::Zero());
}

}  // namespace

BindInputs bind_inputs(std::span<const Vec3f> positions, std::span<const Vec3f> normals, const BoneList& bones, const IndexMatrix& nearest,
                       const Matrix& distances) {
  assert(positions.size() == normals.size() && nearest.rows() == at(positions.size()) && distances.rows() == nearest.rows());
  const BoneTree tree(bones);
  BindInputs out;
  for (Eigen::Index v = 0; v < nearest.rows(); ++v)
    out.offsets.push_back(out.offsets.back() + static_cast<std::int32_t>((nearest.row(v).array() >= 0).count()));
  out.features.resize(static_cast<std::size_t>(out.offsets.back()) * kBindFeatures);
  out.bones.resize(static_cast<std::size_t>(out.offsets.back()));
  parallel_for(positions.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const auto first = static_cast<std::size_t>(nearest(at(v), 0));
      const float least = distances(at(v), 0);
      const Vec3f& x = positions[v];
      const Vec3f first_axis = direction_or_zero(bones.segments[first].b - bones.segments[first].a);
      float* row = out.features.data() + static_cast<std::size_t>(out.offsets[v]) * kBindFeatures;
      for (int k = 0; k < out.offsets[v + 1] - out.offsets[v]; ++k, row += kBindFeatures) {
        const auto bone = static_cast<std::size_t>(nearest(at(v), k));
        const auto& [a, b] = bones.segments[bone];
        const float distance = distances(at(v), k), length = (b - a).norm();
        const float along = length > 1e-6f ? (x - a).dot(b - a) / (length * length) : 0.0f;
        const Vec3f from_bone = x - (a + std::clamp(along, 0.0f, 1.0f) * (b - a));
        const Relation relation = tree.of(bone, first);
        const Place& start = tree.start_of(bone);
        out.bones[static_cast<std::size_t>(out.offsets[v] + k)] = static_cast<std::int32_t>(bone);
        const float values[kBindFeatures] = {proximity(distance),
                                             std::log((distance + kSmall) / (least + kSmall)),
                                             log_length(distance),
                                             from_bone.norm() / (distance + 1e-3f),
                                             std::clamp(along, -1.0f, 2.0f),
                                             5.0f * length,
                                             bones.ends[bone] < 0 ? 1.0f : 0.0f,
                                             log_length((x - a).norm()),
                                             log_length((x - b).norm()),
                                             normals[v].dot(direction_or_zero(from_bone)),
                                             first_axis.dot(direction_or_zero(b - a)),
                                             k == 0 ? 1.0f : 0.0f,
                                             relation.is_child ? 1.0f : 0.0f,
                                             relation.is_parent ? 1.0f : 0.0f,
                                             relation.is_sibling ? 1.0f : 0.0f,
                                             static_cast<float>(k) / kBindBones,
                                             std::min(distance / (length + 0.02f), 5.0f),
                                             10.0f * least,
                                             0.3f * static_cast<float>(start.children),
                                             5.0f * start.parent_length,
                                             start.parent < 0 ? 1.0f : 0.0f};
        std::ranges::copy(values, row);
      }
    }
  });
  return out;
}

}  // namespace osteon::geometry
