// SPDX-License-Identifier: Apache-2.0
#include "osteon/metrics/tree_edit_distance.h"

#include <algorithm>
#include <cassert>

#include "osteon/metrics/assignment.h"

namespace osteon::metrics {
namespace {

using Children = std::vector<JointId>;

// Joints in the tree below and with each joint: the cost to delete or insert it.
PerJoint<int> subtree_sizes(const Skeleton& skeleton) {
  PerJoint<int> sizes(skeleton.size(), 1);
  for (std::size_t j = skeleton.size(); j-- > 1;) {  // children come after their parents
    const JointId joint{static_cast<std::uint16_t>(j)};
    sizes[*skeleton.parents[joint]] += sizes[joint];
  }
  return sizes;
}

// Zhang's recursion: T(i,j) is the distance between the trees at joints i and j, F(i,j) that between the forests of their children.
class Distances {
 public:
  Distances(const Skeleton& a, const Skeleton& b, const PerJoint<std::optional<JointId>>& partner)
      : partner_(partner),
        children_a_(children(a)),
        children_b_(children(b)),
        size_a_(subtree_sizes(a)),
        size_b_(subtree_sizes(b)),
        trees_(a.size(), b.size()),
        forests_(a.size(), b.size()) {
    for (std::size_t i = a.size(); i-- > 0;)  // leaves first
      for (std::size_t j = b.size(); j-- > 0;) {
        const JointId in_a{static_cast<std::uint16_t>(i)}, in_b{static_cast<std::uint16_t>(j)};
        forest(in_a, in_b) = forest_distance(in_a, in_b);
        tree(in_a, in_b) = tree_distance(in_a, in_b);
      }
  }
  int tree(JointId i, JointId j) const { return trees_(static_cast<int>(i), static_cast<int>(j)); }

 private:
  int& tree(JointId i, JointId j) { return trees_(static_cast<int>(i), static_cast<int>(j)); }
  int& forest(JointId i, JointId j) { return forests_(static_cast<int>(i), static_cast<int>(j)); }

  int tree_distance(JointId i, JointId j) {
    int best = forest(i, j) + (partner_[i] == j ? 0 : 1);
    for (JointId kid : children_b_[j]) best = std::min(best, size_b_[j] - size_b_[kid] + tree(i, kid));
    for (JointId kid : children_a_[i]) best = std::min(best, size_a_[i] - size_a_[kid] + tree(kid, j));
    return best;
  }

  int forest_distance(JointId i, JointId j) {
    int best = matched_children(children_a_[i], children_b_[j]);
    for (JointId kid : children_b_[j]) best = std::min(best, size_b_[j] - size_b_[kid] + forest(i, kid));
    for (JointId kid : children_a_[i]) best = std::min(best, size_a_[i] - size_a_[kid] + forest(kid, j));
    return best;
  }

  // The cheapest way to turn children into one another, delete or insert them whole: rows are a's children, then b's insertions.
  int matched_children(const Children& of_a, const Children& of_b) {
    const auto n = static_cast<Eigen::Index>(of_a.size()), m = static_cast<Eigen::Index>(of_b.size());
    if (n + m == 0) return 0;
    Matrix cost = Matrix::Zero(n + m, n + m);
    for (Eigen::Index r = 0; r < n + m; ++r)
      for (Eigen::Index c = 0; c < n + m; ++c) {
        const JointId in_a = r < n ? of_a[static_cast<std::size_t>(r)] : JointId{0},
                      in_b = c < m ? of_b[static_cast<std::size_t>(c)] : JointId{0};
        if (r < n && c < m) cost(r, c) = static_cast<float>(tree(in_a, in_b));
        if (r < n && c >= m) cost(r, c) = static_cast<float>(size_a_[in_a]);
        if (r >= n && c < m) cost(r, c) = static_cast<float>(size_b_[in_b]);
      }
    const auto columns = assign(cost);
    float total = 0.0f;
    for (Eigen::Index r = 0; r < n + m; ++r) total += cost(r, static_cast<Eigen::Index>(*columns[static_cast<std::size_t>(r)]));
    return static_cast<int>(total);
  }

  const PerJoint<std::optional<JointId>>& partner_;
  PerJoint<Children> children_a_, children_b_;
  PerJoint<int> size_a_, size_b_;
  Eigen::MatrixXi trees_, forests_;
};

}  // namespace

int tree_edit_distance(const Skeleton& a, const Skeleton& b, const PerJoint<std::optional<JointId>>& partner) {
  assert(partner.size() == a.size());
  const Distances distances(a, b, partner);
  return distances.tree(JointId{0}, JointId{0});
}

}  // namespace osteon::metrics
