// SPDX-License-Identifier: Apache-2.0
#include "osteon/skin/neuro_features.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>

#include "osteon/base/parallel.h"

namespace osteon::skin {
namespace {

constexpr std::size_t kVerticesPerTask = 256;
constexpr float kSmall = 0.005f;  // added to lengths before the logarithm

float log_length(float length) { return std::log(length + kSmall) + 3.0f; }

float distance_to(const Segment& s, const Vec3f& p) {
  const Vec3f way = s.b - s.a;
  const float squared = way.squaredNorm();
  const float t = squared > 0.0f ? std::clamp((p - s.a).dot(way) / squared, 0.0f, 1.0f) : 0.0f;
  return (p - s.a - t * way).norm();
}

// How a joint hangs in its tree.
struct TreePlaces {
  PerJoint<std::vector<JointId>> kids;
  PerJoint<float> depth, below;  // steps from the root; joints below and itself

  explicit TreePlaces(const Skeleton& skeleton) : kids(children(skeleton)), depth(skeleton.size(), 0.0f), below(skeleton.size(), 1.0f) {
    for (JointId j : skeleton.names.ids())
      if (const auto parent = skeleton.parents[j]) depth[j] = depth[*parent] + 1.0f;
    for (std::size_t j = skeleton.size(); j-- > 1;) below[*skeleton.parents[static_cast<JointId>(j)]] += below[static_cast<JointId>(j)];
  }
};

float nearest_joint(const Skeleton& skeleton, JointId joint) {
  float least = 1.0f;
  for (JointId j : skeleton.names.ids())
    if (j != joint) least = std::min(least, (skeleton.rest_positions[j] - skeleton.rest_positions[joint]).norm());
  return least;
}

// `territory`: the share of the vertices that the joint is nearest to.
void append_joint(std::vector<float>& to, const Skeleton& skeleton, const TreePlaces& places, JointId j, const Slot& slot, bool by_name,
                  float territory, int kinds) {
  const auto parent = skeleton.parents[j];
  const Vec3f& p = skeleton.rest_positions[j];
  float longest = 0.0f;
  for (JointId child : places.kids[j]) longest = std::max(longest, (skeleton.rest_positions[child] - p).norm());
  const std::array<float, kJointFeatures> values{by_name ? 1.0f : 0.0f,
                                                 slot.kind == 0 ? 1.0f : 0.0f,
                                                 places.kids[j].empty() ? 1.0f : 0.0f,
                                                 0.3f * static_cast<float>(places.kids[j].size()),
                                                 0.5f * std::log(places.below[j]),
                                                 0.1f * places.depth[j],
                                                 5.0f * longest,
                                                 parent ? 5.0f * (p - skeleton.rest_positions[*parent]).norm() : 0.0f,
                                                 p.y(),
                                                 std::abs(p.x()),
                                                 parent ? 0.0f : 1.0f,
                                                 0.25f * std::log(static_cast<float>(skeleton.size())),
                                                 parent ? 0.3f * static_cast<float>(places.kids[*parent].size() - 1) : 0.0f,
                                                 log_length(nearest_joint(skeleton, j)),
                                                 slot.name.side == Side::none ? 1.0f : 0.0f,
                                                 0.3f * std::log(territory + 0.002f)};
  to.insert(to.end(), values.begin(), values.end());
  to.resize(to.size() + static_cast<std::size_t>(kinds), 0.0f);
  assert(slot.kind < kinds);
  to[to.size() - static_cast<std::size_t>(kinds - slot.kind)] = 1.0f;
}

}  // namespace

ChoiceRows choice_rows(std::span<const Vec3f> positions, std::span<const Vec3f> normals, const Skeleton& skeleton,
                       const BoneChoices& choices, const SuperSkeleton& super, const SlotAssignment& assignment, int kinds) {
  const geometry::BindInputs inputs = geometry::bind_inputs(positions, normals, choices.bones, choices.nearest, choices.distances);
  ChoiceRows out;
  out.offsets = inputs.offsets;
  const std::size_t rows = inputs.bones.size();
  out.features.resize(rows * kChoiceFeatures);
  out.log_shares.resize(rows);
  out.joints.resize(rows);
  parallel_for(positions.size(), kVerticesPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const float largest = choices.shares.row(static_cast<Eigen::Index>(v)).maxCoeff();
      for (auto row = static_cast<std::size_t>(inputs.offsets[v]); row < static_cast<std::size_t>(inputs.offsets[v + 1]); ++row) {
        const auto k = static_cast<Eigen::Index>(row) - inputs.offsets[v];
        const float share = choices.shares(static_cast<Eigen::Index>(v), k);
        out.joints[row] = choices.bones.starts[static_cast<std::size_t>(inputs.bones[row])];
        out.log_shares[row] = std::log(share + kLeastShare);
        float* to = std::copy_n(inputs.features.data() + row * geometry::kBindFeatures, geometry::kBindFeatures,
                                out.features.data() + row * kChoiceFeatures);
        *to++ = share;
        *to++ = out.log_shares[row] / 3.0f;
        *to++ = share == largest ? 1.0f : 0.0f;
        *to++ = largest;
        *to++ = 0.1f * static_cast<float>(inputs.offsets[v + 1] - inputs.offsets[v]);
      }
    }
  });

  std::vector<float> territory(skeleton.size(), 0.0f);
  for (std::size_t v = 0; v < positions.size(); ++v)
    territory[static_cast<std::size_t>(out.joints[static_cast<std::size_t>(out.offsets[v])])] +=
        1.0f / static_cast<float>(positions.size());
  out.chosen = out.joints;
  std::ranges::sort(out.chosen);
  const auto copies = std::ranges::unique(out.chosen);
  out.chosen.erase(copies.begin(), copies.end());
  const TreePlaces places(skeleton);
  for (const std::int32_t joint : out.chosen) {
    const auto j = static_cast<JointId>(joint);
    append_joint(out.joint_features, skeleton, places, j, super.slots()[assignment.slot[j]], assignment.by_name[j],
                 territory[static_cast<std::size_t>(joint)], kinds);
  }
  return out;
}

std::vector<float> slot_rows(std::span<const Vec3f> positions, std::span<const Vec3f> normals, const Skeleton& skeleton,
                             const SuperSkeleton& super, const SlotAssignment& assignment, int slots) {
  JointId origin{0};
  for (JointId j : skeleton.names.ids())
    if (super.slots()[assignment.slot[j]].name.kind == "hips") {
      origin = j;
      break;
    }
  const Vec3f middle = skeleton.rest_positions[origin];
  const std::vector<Bone> all = bones(skeleton);
  const std::size_t width = 6 + static_cast<std::size_t>(slots);
  std::vector<float> out(positions.size() * width, kNoSlot);
  parallel_for(positions.size(), kVerticesPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      float* row = out.data() + v * width;
      const Vec3f p = positions[v] - middle;
      std::copy_n(p.data(), 3, row);
      std::copy_n(normals[v].data(), 3, row + 3);
      for (const Bone& bone : all) {
        float& distance = row[6 + assignment.slot[bone.start]];
        distance = std::min(distance, distance_to(bone.segment, positions[v]));
      }
    }
  });
  return out;
}

}  // namespace osteon::skin
