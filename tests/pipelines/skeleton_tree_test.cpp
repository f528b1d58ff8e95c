// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/skeleton_tree.h"

#include <algorithm>
#include <cmath>

#include "osteon/base/random.h"
#include "osteon/mesh/shapes.h"
#include "support/expect.h"

namespace osteon::pipelines {
namespace {

using Edges = std::vector<std::pair<std::size_t, std::size_t>>;

// `middles` joints on the plane, then `pairs` mirror pairs, then `singles` without a partner, at random places.
JointSet random_joints(int middles, int pairs, int singles, Random& random) {
  JointSet joints;
  const auto add = [&](const Vec3f& p, std::optional<std::size_t> partner) {
    joints.positions.push_back(p);
    joints.partner.push_back(partner);
  };
  const auto place = [&](float x) { return Vec3f(x, random.uniform(), random.uniform(-0.2f, 0.2f)); };
  for (int i = 0; i < middles; ++i) add(place(0.0f), joints.size());
  for (int i = 0; i < pairs; ++i) {
    const Vec3f left = place(random.uniform(0.1f, 0.5f));
    add(left, joints.size() + 1);
    add(mirrored(left), joints.size() - 1);
  }
  for (int i = 0; i < singles; ++i) add(place(random.uniform(-0.5f, 0.5f)), std::nullopt);
  return joints;
}

TreeEvidence random_evidence(std::size_t joints, Random& random) {
  const auto n = static_cast<Eigen::Index>(joints);
  TreeEvidence e{Matrix::Zero(n, n), {}, Matrix::Zero(n, n)};
  for (Eigen::Index i = 0; i < n; ++i) {
    e.root_probability.push_back(random.uniform());
    for (Eigen::Index j = i + 1; j < n; ++j) {
      e.bone_probability(i, j) = e.bone_probability(j, i) = random.uniform(0.01f, 0.99f);
      e.outside(i, j) = e.outside(j, i) = static_cast<float>(random.below(6));
    }
  }
  return e;
}

Edges edges_of(const JointTree& tree) {
  Edges out;
  for (std::size_t j = 0; j < tree.parents.size(); ++j)
    if (tree.parents[j]) out.emplace_back(std::min(j, *tree.parents[j]), std::max(j, *tree.parents[j]));
  std::ranges::sort(out);
  return out;
}

Edges mirrored(const Edges& edges, const JointSet& joints) {
  Edges out;
  for (auto [a, b] : edges) {
    const std::size_t x = *joints.partner[a], y = *joints.partner[b];
    out.emplace_back(std::min(x, y), std::max(x, y));
  }
  std::ranges::sort(out);
  return out;
}

// The documented cost of a bone, without the mirror mean: summed over a symmetric set of bones it is the same.
double cost(const JointSet& joints, const TreeEvidence& e, const Edges& edges) {
  const TreeOptions options;
  double sum = 0.0;
  for (auto [a, b] : edges) {
    const auto value = [&](const Matrix& m) {
      const auto at = [&](std::size_t i, std::size_t j) {
        return static_cast<double>(m(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)));
      };
      if (!joints.partner[a] || !joints.partner[b]) return at(a, b);
      return 0.5 * (at(a, b) + at(*joints.partner[a], *joints.partner[b]));
    };
    const bool in_plane = joints.partner[a] == a && joints.partner[b] == b;
    sum += (-std::log(value(e.bone_probability)) +
            static_cast<double>(TreeOptions{}.outside_penalty) * std::max(0.0, value(e.outside) - 1.0)) *
           (in_plane ? 0.5 : 1.0);
  }
  return sum;
}

// Every labelled tree on n joints, by its Pruefer sequence.
template <class Visit>
void for_each_tree(std::size_t n, const Visit& visit) {
  std::size_t count = 1;
  for (std::size_t k = 0; k + 2 < n; ++k) count *= n;
  for (std::size_t code = 0; code < count; ++code) {
    std::vector<std::size_t> sequence, degree(n, 1);
    for (std::size_t k = 0, rest = code; k + 2 < n; ++k, rest /= n) {
      sequence.push_back(rest % n);
      ++degree[rest % n];
    }
    Edges edges;
    for (std::size_t s : sequence) {
      const std::size_t leaf = static_cast<std::size_t>(std::ranges::find(degree, 1u) - degree.begin());
      edges.emplace_back(std::min(leaf, s), std::max(leaf, s));
      --degree[leaf];
      --degree[s];
    }
    const std::size_t a = static_cast<std::size_t>(std::ranges::find(degree, 1u) - degree.begin());
    const std::size_t b =
        static_cast<std::size_t>(std::find(degree.begin() + static_cast<std::ptrdiff_t>(a) + 1, degree.end(), 1u) - degree.begin());
    edges.emplace_back(a, b);
    std::ranges::sort(edges);
    visit(edges);
  }
}

TEST(SkeletonTree, is_the_cheapest_of_all_symmetric_trees) {
  Random random(21);
  for (auto [middles, pairs] : {std::pair(2, 2), {3, 1}, {1, 2}, {0, 3}, {0, 2}, {0, 1}}) {
    const JointSet joints = random_joints(middles, pairs, 0, random);
    const TreeEvidence evidence = random_evidence(joints.size(), random);
    double least = 1e9;
    for_each_tree(joints.size(), [&](const Edges& edges) {
      if (mirrored(edges, joints) == edges) least = std::min(least, cost(joints, evidence, edges));
    });
    const Edges found = edges_of(connect(joints, evidence));
    EXPECT_EQ(found.size(), joints.size() - 1);
    EXPECT_EQ(mirrored(found, joints), found);
    EXPECT_NEAR(cost(joints, evidence, found), least, 1e-4) << middles << " on the plane, " << pairs << " pairs";
  }
}

TEST(SkeletonTree, without_symmetry_is_the_minimum_spanning_tree) {
  Random random(22);
  const JointSet joints = random_joints(0, 0, 6, random);
  const TreeEvidence evidence = random_evidence(joints.size(), random);
  double least = 1e9;
  for_each_tree(joints.size(), [&](const Edges& edges) { least = std::min(least, cost(joints, evidence, edges)); });
  const JointTree tree = connect(joints, evidence);
  EXPECT_NEAR(cost(joints, evidence, edges_of(tree)), least, 1e-4);
  EXPECT_EQ(tree.root, static_cast<std::size_t>(std::ranges::max_element(evidence.root_probability) - evidence.root_probability.begin()));
}

TEST(SkeletonTree, every_joint_hangs_on_the_root) {
  Random random(23);
  for (auto [middles, pairs, singles] : {std::tuple(1, 0, 0), {0, 0, 1}, {4, 9, 3}, {0, 5, 4}, {7, 0, 0}, {2, 20, 0}}) {
    const JointSet joints = random_joints(middles, pairs, singles, random);
    const JointTree tree = connect(joints, random_evidence(joints.size(), random));
    EXPECT_FALSE(tree.parents[tree.root].has_value());
    for (std::size_t j = 0; j < joints.size(); ++j) {
      std::size_t at = j, steps = 0;
      for (; tree.parents[at] && steps <= joints.size(); ++steps) at = *tree.parents[at];
      EXPECT_EQ(at, tree.root);
    }
    if (middles > 0) {
      EXPECT_EQ(joints.partner[tree.root], tree.root);
    }
  }
}

TEST(SkeletonTree, certain_bones_are_taken_and_impossible_ones_still_connect) {
  Random random(24);
  const JointSet joints = random_joints(3, 2, 0, random);
  TreeEvidence evidence{Matrix::Zero(7, 7), std::vector<float>(7, 0.0f), Matrix::Zero(7, 7)};
  const Edges wanted{{0, 1}, {1, 2}, {1, 3}, {1, 4}, {3, 5}, {4, 6}};
  for (auto [a, b] : wanted)
    evidence.bone_probability(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)) = evidence.bone_probability(
        static_cast<Eigen::Index>(b), static_cast<Eigen::Index>(a)) = 1.0f;  // saturated, as a sigmoid in float does
  EXPECT_EQ(edges_of(connect(joints, evidence)), wanted);
  evidence.bone_probability.setZero();
  EXPECT_EQ(edges_of(connect(joints, evidence)).size(), 6u);
  evidence.bone_probability.setConstant(NAN);
  EXPECT_EQ(edges_of(connect(joints, evidence)).size(), 6u);
}

TEST(SkeletonTree, leaving_the_volume_costs_and_never_pays) {
  JointSet joints;
  for (float x : {0.0f, 0.2f, 0.4f}) {
    joints.positions.emplace_back(x, 0, 0);
    joints.partner.push_back(std::nullopt);
  }
  TreeEvidence evidence{Matrix::Constant(3, 3, 0.5f), {1, 0, 0}, Matrix::Zero(3, 3)};
  evidence.bone_probability(0, 1) = evidence.bone_probability(1, 0) = 0.01f;
  evidence.outside(0, 1) = evidence.outside(1, 0) = 2.0f;  // the authors' code would make it 4 = 2 * 2, cheaper than -ln 0.01
  evidence.bone_probability(0, 2) = evidence.bone_probability(2, 0) = 0.011f;
  EXPECT_EQ(edges_of(connect(joints, evidence)), (Edges{{0, 2}, {1, 2}}));
}

TEST(SkeletonTree, outside_samples_are_those_of_the_segment_beyond_the_solid) {
  const auto mesh = shapes::merged(shapes::transformed(shapes::box({0.4f, 0.3f, 0.3f}), Transform(Eigen::Translation3f(-0.3f, 0, 0))),
                                   shapes::transformed(shapes::box({0.4f, 0.4f, 0.4f}), Transform(Eigen::Translation3f(0.3f, 0, 0))));
  const std::vector<Vec3f> joints{{-0.3f, 0, 0}, {-0.2f, 0.1f, 0}, {0.3f, 0, 0}};
  const Matrix outside = samples_outside(joints, geometry::voxelize(mesh, 50));
  EXPECT_EQ(outside(0, 1), 0.0f);
  EXPECT_NEAR(outside(0, 2), 20.0f, 4.0f);  // the gap of 0.2, less the surface voxels on both sides
  EXPECT_EQ(outside, Matrix(outside.transpose()));
}

// A person: pelvis, spine, head; legs of three joints; arms of three with two fingers.
struct Person {
  JointSet joints;
  TreeEvidence evidence;
};
Person person() {
  Person p;
  Edges bones;
  const auto middle = [&](const Vec3f& at, std::optional<std::size_t> parent) {
    p.joints.positions.push_back(at);
    p.joints.partner.push_back(p.joints.size() - 1);
    if (parent) bones.emplace_back(*parent, p.joints.size() - 1);
    return p.joints.size() - 1;
  };
  const auto pair = [&](const Vec3f& at, std::size_t parent) {
    const std::size_t left = p.joints.size(), right = left + 1;
    p.joints.positions.push_back(at);
    p.joints.positions.push_back(pipelines::mirrored(at));
    p.joints.partner.push_back(right);
    p.joints.partner.push_back(left);
    bones.emplace_back(parent, left);
    bones.emplace_back(*p.joints.partner[parent], right);
    if (p.joints.partner[parent] == parent) bones.back().first = parent;
    return left;
  };
  const std::size_t pelvis = middle({0, 0.5f, 0}, {}), chest = middle({0, 0.7f, 0}, pelvis);
  middle({0, 0.9f, 0}, chest);
  pair({0.08f, 0.02f, 0.03f}, pair({0.08f, 0.25f, 0}, pair({0.08f, 0.47f, 0}, pelvis)));
  const std::size_t hand = pair({0.4f, 0.75f, 0}, pair({0.25f, 0.75f, 0}, pair({0.12f, 0.75f, 0}, chest)));
  pair({0.45f, 0.75f, 0.02f}, hand);
  pair({0.44f, 0.74f, 0.04f}, hand);
  const auto n = static_cast<Eigen::Index>(p.joints.size());
  p.evidence = {Matrix::Constant(n, n, 0.01f), std::vector<float>(p.joints.size(), 0.1f), Matrix::Zero(n, n)};
  p.evidence.root_probability[pelvis] = 0.9f;
  for (auto [a, b] : bones)
    p.evidence.bone_probability(static_cast<Eigen::Index>(a), static_cast<Eigen::Index>(b)) =
        p.evidence.bone_probability(static_cast<Eigen::Index>(b), static_cast<Eigen::Index>(a)) = 0.9f;
  return p;
}

TEST(SkeletonTree, makes_a_valid_named_skeleton_in_world_space) {
  const Person p = person();
  const JointTree tree = connect(p.joints, p.evidence);
  EXPECT_NEAR(tree.likelihood, 0.9f, 1e-4f);
  const auto [skeleton, from] = make_skeleton(p.joints, tree, {0.5f, Vec3f(0, 1, 0)});
  validate(skeleton);
  ASSERT_EQ(skeleton.size(), p.joints.size());
  for (JointId j : skeleton.names.ids())
    EXPECT_VEC3_NEAR(skeleton.rest_positions[j], p.joints.positions[from[j]] * 2.0f + Vec3f(0, 1, 0), 1e-6f);
  const auto has = [&](const std::string& name) { return std::ranges::count(skeleton.names, name) == 1; };
  for (const char* name :
       {"root", "spine_1", "spine_2", "left_leg_1", "right_leg_3", "left_arm_1", "right_arm_4", "left_arm_branch_1", "right_arm_branch_1"})
    EXPECT_TRUE(has(name)) << name;
}

TEST(SkeletonTree, partners_differ_by_left_and_right_in_their_names) {
  const Person p = person();
  const auto [skeleton, from] = make_skeleton(p.joints, connect(p.joints, p.evidence), {1.0f, Vec3f::Zero()});
  std::vector<std::string> name_of(skeleton.size());
  for (JointId j : skeleton.names.ids()) name_of[from[j]] = skeleton.names[j];
  for (std::size_t j = 0; j < name_of.size(); ++j) {
    if (p.joints.positions[j].x() <= 0.0f) continue;
    ASSERT_EQ(name_of[j].substr(0, 5), "left_");
    EXPECT_EQ(name_of[*p.joints.partner[j]], "right_" + name_of[j].substr(5));
  }
}

TEST(SkeletonTree, seen_from_behind_left_is_right) {
  const Person p = person();
  const JointTree tree = connect(p.joints, p.evidence);
  const auto [before, from] = make_skeleton(p.joints, tree, {1.0f, Vec3f::Zero()});
  const auto [behind, same] = make_skeleton(p.joints, tree, {1.0f, Vec3f::Zero()}, true);
  EXPECT_EQ(from, same);
  EXPECT_EQ(before.rest_positions, behind.rest_positions);
  for (JointId j : from.ids())
    if (p.joints.positions[from[j]].x() > 0.0f) {
      EXPECT_TRUE(before.names[j].starts_with("left_") && behind.names[j].starts_with("right_"));
    }
}

}  // namespace
}  // namespace osteon::pipelines
