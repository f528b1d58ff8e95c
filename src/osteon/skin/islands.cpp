// SPDX-License-Identifier: Apache-2.0
#include "osteon/skin/islands.h"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace osteon::skin {
namespace {

struct Island {
  Eigen::AlignedBox3f box;
  std::map<JointId, double> weights;
  double total = 0.0;
};

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

// The joint that the island follows; empty where it bends.
std::optional<JointId> joint_of(const Island& island, float diagonal, const IslandOptions& options) {
  if (island.box.diagonal().norm() > options.largest * diagonal) return std::nullopt;
  JointId best{};
  double most = 0.0, second = 0.0;
  for (const auto& [joint, weight] : island.weights) {
    if (weight > most) {
      second = std::exchange(most, weight);
      best = joint;
    } else {
      second = std::max(second, weight);
    }
  }
  if (most < static_cast<double>(options.main) * island.total || second > static_cast<double>(options.second) * most) return std::nullopt;
  return best;
}

}  // namespace

std::size_t make_islands_rigid(WeightRows& rows, const TriangleMesh& mesh, const IslandOptions& options) {
  const Components parts = connected_components(mesh);
  if (parts.count < 2) return 0;
  const float diagonal = bounds(mesh).diagonal().norm();
  std::vector<std::optional<JointId>> joints;
  std::size_t rigid = 0;
  for (const Island& island : measured(rows, mesh, parts)) {
    joints.push_back(joint_of(island, diagonal, options));
    rigid += joints.back().has_value();
  }
  for (VertexId v : mesh.positions.ids())
    if (const auto& joint = joints[parts.of[v]]) rows[v] = {{*joint, 1.0f}};
  return rigid;
}

std::size_t make_islands_rigid(SkinWeights& weights, const geometry::CleanMesh& clean, const IslandOptions& options) {
  WeightRows rows(clean.mesh.positions.size());
  for (VertexId v : clean.from_original.ids()) rows[clean.from_original[v]].assign(weights[v].begin(), weights[v].end());
  for (WeightRow& row : rows) merge(row);
  const std::size_t rigid = make_islands_rigid(rows, clean.mesh, options);
  if (rigid > 0) weights = to_skin_weights(rows, clean.from_original);
  return rigid;
}

}  // namespace osteon::skin
