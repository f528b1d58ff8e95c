// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <vector>

#include "osteon/base/parallel.h"
#include "osteon/skin/weight_rows.h"

namespace osteon::skin {

// For each joint j with a source: the solution of A x = (scale * sources of j), as weights of j, clamped to 0..1; then sums 1. `solver`
// holds the factors of A. Rows that get nothing keep their source.
template <class Solver>
WeightRows solved_for_joints(const WeightRows& sources, const Eigen::VectorXd& scale, const Solver& solver) {
  std::vector<std::vector<std::pair<VertexId, float>>> by_joint;
  for (VertexId v : sources.ids())
    for (const Influence& i : sources[v]) {
      by_joint.resize(std::max(by_joint.size(), index(i.joint) + 1));
      by_joint[index(i.joint)].emplace_back(v, i.weight);
    }
  constexpr double kNothing = 1e-4;
  std::vector<std::vector<std::pair<VertexId, float>>> solved(by_joint.size());
  parallel_for(by_joint.size(), 1, [&](std::size_t j, std::size_t) {
    if (by_joint[j].empty()) return;
    Eigen::VectorXd right = Eigen::VectorXd::Zero(scale.size());
    for (const auto& [v, weight] : by_joint[j])
      right[static_cast<Eigen::Index>(index(v))] = static_cast<double>(weight) * scale[static_cast<Eigen::Index>(index(v))];
    const Eigen::VectorXd x = solver.solve(right);
    for (Eigen::Index v = 0; v < x.size(); ++v)
      if (x[v] > kNothing) solved[j].emplace_back(static_cast<VertexId>(v), static_cast<float>(std::min(1.0, x[v])));
  });
  WeightRows out(sources.size());
  for (std::size_t j = 0; j < solved.size(); ++j)
    for (const auto& [v, weight] : solved[j]) out[v].push_back({static_cast<JointId>(j), weight});
  for (VertexId v : out.ids()) {
    if (out[v].empty()) out[v] = sources[v];
    normalize(out[v]);
  }
  return out;
}

}  // namespace osteon::skin
