// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>

#include "osteon/io/gltf/writer.h"
#include "osteon/rig/skeleton.h"

namespace osteon::io::gltf {

struct JointNodes {
  std::size_t root;  // node, to be listed in the scene
  std::size_t skin;
};

// Appends a node for each joint and a skin of them all. `bind` brings the vertices to world space before the joints move them.
// `names` are those that other nodes have; a joint that cannot keep its name (taken; not ASCII; ':' or '/', which Godot does not accept)
// gets another one, and `changes` says so.
JointNodes add_joint_nodes(Writer& writer, Document& document, const Skeleton& skeleton, const Eigen::Affine3d& bind,
                           std::set<std::string> names, std::vector<std::string>& changes);

}  // namespace osteon::io::gltf
