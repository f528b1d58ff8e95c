// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/skeleton_tree.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "osteon/geometry/stance.h"
#include "osteon/pipelines/joint_names.h"

namespace osteon::pipelines {
namespace {

constexpr float kLeastProbability = 1e-6f;  // a network may say 0 or 1 in float: both have a finite cost above zero

std::size_t image(const JointSet& joints, std::size_t j) { return joints.partner[j].value_or(j); }
bool in_middle(const JointSet& joints, std::size_t j) { return joints.partner[j] == j; }
bool in_pair(const JointSet& joints, std::size_t j) { return joints.partner[j] && joints.partner[j] != j; }

// The same for a pair of joints and its mirror image. A joint without a partner has none, and neither have its pairs.
float mirror_mean(const JointSet& joints, const Matrix& values, std::size_t i, std::size_t j) {
  const auto at = [&](std::size_t a, std::size_t b) { return values(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)); };
  if (!joints.partner[i] || !joints.partner[j]) return at(i, j);
  return 0.5f * (at(i, j) + at(image(joints, i), image(joints, j)));
}

class Costs {
 public:
  Costs(const JointSet& joints, const TreeEvidence& evidence, const TreeOptions& options)
      : joints_(joints), evidence_(evidence), options_(options) {}

  float probability(std::size_t i, std::size_t j) const {
    const float p = mirror_mean(joints_, evidence_.bone_probability, i, j);
    return p > kLeastProbability ? std::min(p, 1.0f - kLeastProbability) : kLeastProbability;  // not a number: unlikely
  }
  float operator()(std::size_t i, std::size_t j) const {
    const float outside = std::max(0.0f, mirror_mean(joints_, evidence_.outside, i, j) - 1.0f);
    const float cost = -std::log(probability(i, j)) + options_.outside_penalty * outside;
    return in_middle(joints_, i) && in_middle(joints_, j) ? options_.middle_discount * cost : cost;
  }

 private:
  const JointSet& joints_;
  const TreeEvidence& evidence_;
  const TreeOptions& options_;
};

// Prim's algorithm on a tree that may already have joints.
class GrowingTree {
 public:
  GrowingTree(const JointSet& joints, const Costs& costs)
      : joints_(joints), costs_(costs), inside_(joints.size(), false), edges_(joints.size()) {}

  void start(std::size_t j) { inside_[j] = true; }
  void join(std::size_t i, std::size_t j) {
    inside_[i] = inside_[j] = true;
    edges_[i].push_back(j);
    edges_[j].push_back(i);
  }
  bool empty() const {
    return std::ranges::none_of(inside_, [](bool b) { return b; });
  }

  // Attaches all of `joints` that are not in the tree yet. Of a mirror pair the first stands for both: what it is attached to, its
  // partner is attached to the image of.
  void grow(const std::vector<std::size_t>& units) {
    while (const auto next = cheapest(units)) {
      const auto [unit, target] = *next;
      join(unit, target);
      if (in_pair(joints_, unit)) join(image(joints_, unit), image(joints_, target));
    }
  }

  const std::vector<std::vector<std::size_t>>& edges() const { return edges_; }

 private:
  struct Attachment {
    std::size_t unit, target;
  };
  std::optional<Attachment> cheapest(const std::vector<std::size_t>& units) const {
    std::optional<Attachment> best;
    float least = std::numeric_limits<float>::infinity();
    for (std::size_t unit : units) {
      if (inside_[unit]) continue;
      for (std::size_t target = 0; target < inside_.size(); ++target)
        if (inside_[target] && costs_(unit, target) < least) {
          least = costs_(unit, target);
          best = {unit, target};
        }
    }
    return best;
  }

  const JointSet& joints_;
  const Costs& costs_;
  std::vector<bool> inside_;
  std::vector<std::vector<std::size_t>> edges_;
};

template <class Condition>
std::vector<std::size_t> joints_where(const JointSet& joints, const Condition& condition) {
  std::vector<std::size_t> out;
  for (std::size_t j = 0; j < joints.size(); ++j)
    if (condition(j)) out.push_back(j);
  return out;
}

// Smaller index first where equal.
std::size_t likeliest_root(const std::vector<std::size_t>& candidates, const JointSet& joints, const std::vector<float>& probability) {
  const auto both = [&](std::size_t j) { return probability[j] + probability[image(joints, j)]; };
  return *std::ranges::max_element(candidates, {}, both);
}

void orient(JointTree& tree, const std::vector<std::vector<std::size_t>>& edges) {
  tree.parents.assign(edges.size(), std::nullopt);
  std::vector<std::size_t> open{tree.root};
  for (std::size_t k = 0; k < open.size(); ++k)
    for (std::size_t next : edges[open[k]])
      if (next != tree.root && !tree.parents[next]) {
        tree.parents[next] = open[k];
        open.push_back(next);
      }
  assert(open.size() == edges.size());
}

float likelihood(const JointTree& tree, const Costs& costs) {
  double sum = 0.0;
  for (std::size_t j = 0; j < tree.parents.size(); ++j)
    if (tree.parents[j]) sum += std::log(static_cast<double>(costs.probability(j, *tree.parents[j])));
  return tree.parents.size() > 1 ? static_cast<float>(std::exp(sum / static_cast<double>(tree.parents.size() - 1))) : 1.0f;
}

}  // namespace

Matrix samples_outside(std::span<const Vec3f> joints, const geometry::VoxelGrid& voxels) {
  const auto n = static_cast<Eigen::Index>(joints.size());
  Matrix outside = Matrix::Zero(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = i + 1; j < n; ++j)
      outside(i, j) = outside(j, i) =
          static_cast<float>(geometry::samples_outside(voxels, {joints[static_cast<std::size_t>(i)], joints[static_cast<std::size_t>(j)]}));
  return outside;
}

JointTree connect(const JointSet& joints, const TreeEvidence& evidence, const TreeOptions& options) {
  assert(joints.size() > 0 && evidence.root_probability.size() == joints.size());
  const Costs costs(joints, evidence, options);
  const auto middles = joints_where(joints, [&](std::size_t j) { return in_middle(joints, j); });
  const auto pairs = joints_where(joints, [&](std::size_t j) { return in_pair(joints, j) && *joints.partner[j] > j; });
  const auto singles = joints_where(joints, [&](std::size_t j) { return !joints.partner[j]; });
  JointTree tree;
  GrowingTree growing(joints, costs);
  if (!middles.empty()) {
    tree.root = likeliest_root(middles, joints, evidence.root_probability);
    growing.start(tree.root);
  } else if (!pairs.empty()) {
    tree.root = *std::ranges::min_element(pairs, {}, [&](std::size_t j) { return costs(j, image(joints, j)); });
    growing.join(tree.root, image(joints, tree.root));
  } else {
    tree.root = likeliest_root(singles, joints, evidence.root_probability);
    growing.start(tree.root);
  }
  growing.grow(middles);
  growing.grow(pairs);
  growing.grow(singles);
  orient(tree, growing.edges());
  tree.likelihood = likelihood(tree, costs);
  return tree;
}

TreeSkeleton make_skeleton(const JointSet& joints, const JointTree& tree, const geometry::Normalization& normalization,
                           bool is_seen_from_behind, std::span<const std::optional<HandPart>> parts) {
  const Eigen::Matrix3f to_front = geometry::turn_to_front(is_seen_from_behind ? Vec3f(0, 0, -1) : Vec3f(0, 0, 1));
  std::vector<std::vector<std::size_t>> kids(joints.size());
  for (std::size_t j = 0; j < joints.size(); ++j)
    if (tree.parents[j]) kids[*tree.parents[j]].push_back(j);
  TreeSkeleton out;
  std::vector<JointId> id_of(joints.size());
  std::vector<std::size_t> open{tree.root};
  while (!open.empty()) {
    const std::size_t j = open.back();
    open.pop_back();
    const auto parent = tree.parents[j] ? std::optional(id_of[*tree.parents[j]]) : std::nullopt;
    id_of[j] = out.skeleton.add("", parent, to_front * joints.positions[j]);
    out.from.push_back(j);
    open.insert(open.end(), kids[j].rbegin(), kids[j].rend());
  }
  PerJoint<std::optional<JointId>> partner;
  PerJoint<std::optional<HandPart>> part;
  for (std::size_t j : out.from) {
    partner.push_back(joints.partner[j] ? std::optional(id_of[*joints.partner[j]]) : std::nullopt);
    if (!parts.empty()) part.push_back(parts[j]);
  }
  out.skeleton.names = joint_names(out.skeleton, partner, part);
  for (JointId j : out.from.ids())
    out.skeleton.rest_positions[j] = to_front * normalization.undo(joints.frame.from(joints.positions[out.from[j]]));
  orient_along_bones(out.skeleton);
  out.skeleton = turned(std::move(out.skeleton), to_front);  // a half turn undoes itself
  return out;
}

}  // namespace osteon::pipelines
