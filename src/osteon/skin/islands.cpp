// SPDX-License-Identifier: Apache-2.0
#include "osteon/skin/islands.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace osteon::skin {
namespace {

// Of the joint whose fingers they are: how many at least, how long each, and how far the longest reaches, in parts of the mesh's diagonal.
constexpr std::size_t kFingers = 4, kLeastJoints = 2;
constexpr float kHand = 0.15f;

struct Island {
  Eigen::AlignedBox3f box;
  std::map<JointId, double> weights;
  double total = 0.0;
};

// The joint and what follows it as long as each has one child; empty where it branches.
std::vector<JointId> chain_from(JointId joint, const PerJoint<std::vector<JointId>>& children) {
  std::vector<JointId> chain{joint};
  while (children[chain.back()].size() == 1) chain.push_back(children[chain.back()].front());
  return children[chain.back()].empty() ? chain : std::vector<JointId>{};
}

// For each joint of a finger the palm's, for others themselves.
PerJoint<JointId> palms(const Skeleton& skeleton, float diagonal) {
  PerJoint<JointId> out;
  for (JointId j : skeleton.names.ids()) out.push_back(j);
  const auto children = osteon::children(skeleton);
  for (JointId palm : skeleton.names.ids()) {
    std::vector<std::vector<JointId>> fingers;
    for (JointId child : children[palm])
      if (auto chain = chain_from(child, children); chain.size() >= kLeastJoints) fingers.push_back(std::move(chain));
    const auto reaches_far = [&](const std::vector<JointId>& finger) {
      return (skeleton.rest_positions[finger.back()] - skeleton.rest_positions[palm]).norm() > kHand * diagonal;
    };
    if (fingers.size() < kFingers || std::ranges::any_of(fingers, reaches_far)) continue;
    for (const auto& finger : fingers)
      for (JointId joint : finger) out[joint] = palm;
  }
  return out;
}

std::vector<Island> measured(const WeightRows& rows, const TriangleMesh& mesh, const Components& parts) {
  std::vector<Island> islands(parts.count);
  for (VertexId v : mesh.positions.ids()) {
    Island& island = islands[parts.of[v]];
    island.box.extend(mesh.positions[v]);
    for (const Influence& i : rows[v]) {
      island.weights[i.joint] += static_cast<double>(i.weight);
      island.total += static_cast<double>(i.weight);
    }
  }
  return islands;
}

// The joint that has most of the weight, at least `main` of it and the next at most `second` of that; else none.
std::optional<JointId> clear_joint(const std::map<JointId, double>& weights, double total, float main, float second) {
  JointId best{};
  double most = 0.0, next = 0.0;
  for (const auto& [joint, weight] : weights) {
    if (weight > most) {
      next = std::exchange(most, weight);
      best = joint;
    } else {
      next = std::max(next, weight);
    }
  }
  if (most < static_cast<double>(main) * total || next > static_cast<double>(second) * most) return std::nullopt;
  return best;
}

// The joint that the island follows; empty where it bends.
std::optional<JointId> joint_of(const Island& island, const Skeleton& skeleton, const PerJoint<JointId>& palms, float diagonal,
                                const IslandOptions& options) {
  if (island.box.diagonal().norm() > options.largest * diagonal) return std::nullopt;
  const auto lies_in = [&](const Vec3f& p) { return island.box.contains(p); };
  if (std::ranges::any_of(skeleton.rest_positions, lies_in)) return clear_joint(island.weights, island.total, options.main, options.second);
  const auto clear = [&](const std::map<JointId, double>& weights) {
    return clear_joint(weights, island.total, options.main_without, options.second_without);
  };
  if (const auto joint = clear(island.weights)) return joint;
  std::map<JointId, double> held;
  for (const auto& [j, weight] : island.weights) held[palms[j]] += weight;
  return clear(held);
}

}  // namespace

std::size_t make_islands_rigid(WeightRows& rows, const TriangleMesh& mesh, const Skeleton& skeleton, const IslandOptions& options) {
  const Components parts = connected_components(mesh);
  if (parts.count < 2) return 0;
  const float diagonal = bounds(mesh).diagonal().norm();
  const PerJoint<JointId> palm = palms(skeleton, diagonal);
  std::vector<std::optional<JointId>> joints;
  std::size_t rigid = 0;
  for (const Island& island : measured(rows, mesh, parts)) {
    joints.push_back(joint_of(island, skeleton, palm, diagonal, options));
    rigid += joints.back().has_value();
  }
  for (VertexId v : mesh.positions.ids())
    if (const auto& joint = joints[parts.of[v]]) rows[v] = {{*joint, 1.0f}};
  return rigid;
}

std::size_t make_islands_rigid(SkinWeights& weights, const geometry::CleanMesh& clean, const Skeleton& skeleton,
                               const IslandOptions& options) {
  WeightRows rows(clean.mesh.positions.size());
  for (VertexId v : clean.from_original.ids()) rows[clean.from_original[v]].assign(weights[v].begin(), weights[v].end());
  for (WeightRow& row : rows) merge(row);
  const std::size_t rigid = make_islands_rigid(rows, clean.mesh, skeleton, options);
  if (rigid > 0) weights = to_skin_weights(rows, clean.from_original);
  return rigid;
}

}  // namespace osteon::skin
