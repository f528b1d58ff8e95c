// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/io/scene.h"

namespace osteon::io {

struct JointTree {
  Skeleton skeleton;
  std::vector<std::optional<JointId>> joint_of_node;  // one entry per node of the scene
};

// The node of each joint; none for a root that no node stands for.
std::vector<std::optional<std::size_t>> nodes_of_joints(const JointTree& tree, std::size_t joints);

// The joints of all skins of the scene as one strict tree. A joint's parent is the nearest joint above its node. Several roots are joined
// under the nearest node above all of them, or else under a new joint. Names become unique. Rest pose = the nodes' world transforms.
// Joints come in the order of the skins, moved behind their parents where needed. Empty if no skin has joints.
std::optional<JointTree> joint_tree(const Scene& scene, std::vector<std::string>& repairs);

// For files without skins: all nodes that show no mesh are joints, but for a container that a format puts above them.
std::optional<JointTree> joint_tree_of_nodes(const Scene& scene, std::vector<std::string>& repairs);

}  // namespace osteon::io
