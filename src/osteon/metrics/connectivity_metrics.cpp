// SPDX-License-Identifier: Apache-2.0
#include "osteon/metrics/connectivity_metrics.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <map>
#include <string>

#include "osteon/metrics/tree_edit_distance.h"

namespace osteon::metrics {
namespace {

double share(std::size_t part, std::size_t whole) {
  return whole == 0 ? std::numeric_limits<double>::quiet_NaN() : static_cast<double>(part) / static_cast<double>(whole);
}

bool joined(const Skeleton& skeleton, JointId i, JointId j) { return skeleton.parents[i] == j || skeleton.parents[j] == i; }

PerJoint<std::optional<JointId>> same_names(const Skeleton& tree, const Skeleton& reference) {
  std::map<std::string, JointId> by_name;
  for (JointId j : reference.names.ids()) by_name[reference.names[j]] = j;
  PerJoint<std::optional<JointId>> same;
  for (const std::string& name : tree.names) same.push_back(by_name.at(name));
  return same;
}

}  // namespace

ConnectivityScores compare_connectivity(const Matrix& bone_probability, std::span<const float> root_probability, const Skeleton& tree,
                                        const Skeleton& reference) {
  assert(tree.size() == reference.size() && root_probability.size() == reference.size());
  std::size_t pairs = 0, right = 0, said = 0, both = 0;
  for (JointId i : reference.names.ids())
    for (JointId j : reference.names.ids()) {
      if (i >= j) continue;
      const bool yes = bone_probability(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) > 0.5f, truth = joined(reference, i, j);
      ++pairs;
      right += yes == truth;
      said += yes;
      both += yes && truth;
    }
  const auto same = same_names(tree, reference);
  std::size_t bones = 0;
  for (JointId j : tree.names.ids()) bones += tree.parents[j] && joined(reference, *same[j], *same[*tree.parents[j]]);
  const auto likeliest = std::ranges::max_element(root_probability) - root_probability.begin();
  return {.accuracy = share(right, pairs),
          .precision = share(both, said),
          .recall = share(both, reference.size() - 1),
          .bones = share(bones, reference.size() - 1),
          .tree_edit_distance = static_cast<double>(tree_edit_distance(tree, reference, same)),
          .likeliest_root = likeliest == 0 ? 1.0 : 0.0,  // the reference's root is its joint 0
          .root = same[JointId{0}] == JointId{0} ? 1.0 : 0.0};
}

}  // namespace osteon::metrics
