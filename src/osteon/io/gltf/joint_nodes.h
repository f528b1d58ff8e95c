// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>

#include "osteon/io/gltf/writer.h"
#include "osteon/io/save.h"
#include "osteon/io/source_document.h"
#include "osteon/rig/skeleton.h"

namespace osteon::io::gltf {

struct JointNodes {
  std::size_t root;  // node, to be listed in the scene
  std::size_t skin;
  struct Joint {
    std::size_t node;
    Eigen::Affine3d world;  // as a reader of the file computes it
  };
  std::vector<Joint> joints;  // of the skin
};

// Appends a node for each joint and a skin of them all. `bind` brings the vertices to world space before the joints move them.
// `names` are those that other nodes have. With portable naming a joint that cannot keep its name (taken; not ASCII; ':' or '/', which
// Godot does not accept) gets another one, and `changes` says so.
JointNodes add_joint_nodes(Writer& writer, Document& document, const Skeleton& skeleton, const Eigen::Affine3d& bind, JointNames naming,
                           std::set<std::string> names, std::vector<std::string>& changes);

// The same with the nodes of the skeleton's own file, copied as they are with all that stands above and below the joints (but no meshes and
// cameras), in the order of the file. A node above them applies `fit` where it is not the identity, or where there are several roots.
// Pre: can_copy_joint_nodes, which is can_bind of its nodes.
JointNodes copy_joint_nodes(Writer& writer, Document& document, const SkeletonSource& skeleton, const Eigen::Affine3d& fit,
                            const Eigen::Affine3d& bind);
bool can_copy_joint_nodes(const SkeletonSource& skeleton);

// Whether a mesh can be bound to all of these nodes: none is scaled to nothing.
bool can_bind(const Scene& scene, const std::vector<std::optional<std::size_t>>& node_of_joint);

// The node above others that applies `fit`, a similarity.
Json fitted_node(const std::string& name, const Eigen::Affine3d& fit, const std::vector<std::size_t>& children);

// Which place in the skin of copy_joint_nodes each joint has; joints without a node have that of the first.
std::vector<JointId> places_in_skin(const SkeletonSource& skeleton);

}  // namespace osteon::io::gltf
