// SPDX-License-Identifier: Apache-2.0
#include "osteon/metrics/tree_edit_distance.h"

#include <gtest/gtest.h>

#include <map>
#include <string>

namespace osteon::metrics {
namespace {

using Edges = std::vector<std::pair<std::string, std::string>>;  // child, parent ("" for the root)

Skeleton tree(const Edges& edges) {
  Skeleton skeleton;
  std::map<std::string, JointId> by_name;
  for (const auto& [name, parent] : edges)
    by_name[name] = skeleton.add(name, parent.empty() ? std::nullopt : std::optional(by_name.at(parent)), Vec3f::Zero());
  return skeleton;
}

// Joints of one name are the same.
int distance(const Skeleton& a, const Skeleton& b) {
  PerJoint<std::optional<JointId>> partner(a.size());
  for (JointId i : a.names.ids())
    for (JointId j : b.names.ids())
      if (a.names[i] == b.names[j]) partner[i] = j;
  return tree_edit_distance(a, b, partner);
}

const Edges kBiped{{"hips", ""},      {"spine", "hips"}, {"head", "spine"}, {"armL", "spine"},
                   {"armR", "spine"}, {"legL", "hips"},  {"legR", "hips"},  {"footL", "legL"}};

TEST(TreeEditDistance, is_zero_for_the_same_tree) { EXPECT_EQ(distance(tree(kBiped), tree(kBiped)), 0); }

TEST(TreeEditDistance, does_not_depend_on_the_order_of_children) {
  const Edges shuffled{{"hips", ""},      {"legR", "hips"},  {"legL", "hips"},  {"footL", "legL"},
                       {"spine", "hips"}, {"armR", "spine"}, {"head", "spine"}, {"armL", "spine"}};
  EXPECT_EQ(distance(tree(kBiped), tree(shuffled)), 0);
}

TEST(TreeEditDistance, counts_a_missing_leaf_once) {
  Edges smaller = kBiped;
  smaller.pop_back();
  EXPECT_EQ(distance(tree(kBiped), tree(smaller)), 1);
  EXPECT_EQ(distance(tree(smaller), tree(kBiped)), 1);
}

TEST(TreeEditDistance, counts_a_missing_joint_inside_a_chain_once) {
  const Skeleton chain = tree({{"a", ""}, {"b", "a"}, {"c", "b"}, {"d", "c"}}), shorter = tree({{"a", ""}, {"b", "a"}, {"d", "b"}});
  EXPECT_EQ(distance(chain, shorter), 1);
}

TEST(TreeEditDistance, counts_another_joint_at_a_place_once) {
  EXPECT_EQ(distance(tree({{"a", ""}, {"b", "a"}, {"c", "b"}}), tree({{"a", ""}, {"x", "a"}, {"c", "x"}})), 1);
}

TEST(TreeEditDistance, of_trees_without_a_common_joint_replaces_the_smaller_one_and_inserts_the_rest) {
  EXPECT_EQ(distance(tree({{"a", ""}, {"b", "a"}}), tree({{"w", ""}, {"x", "w"}, {"y", "x"}, {"z", "x"}})), 4);
}

TEST(TreeEditDistance, deletes_and_inserts_a_joint_that_hangs_elsewhere) {
  Edges moved = kBiped;
  moved.back() = {"footL", "legR"};
  EXPECT_EQ(distance(tree(kBiped), tree(moved)), 2);
}

}  // namespace
}  // namespace osteon::metrics
