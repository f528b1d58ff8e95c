// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/io/gltf/document.h"
#include "osteon/io/source_document.h"

namespace osteon::io::gltf {

// A node that must find another place: it hung from an old joint and was none itself (a socket, a camera, a light, or what holds such), or
// was a joint that shows something besides.
struct Attachment {
  std::size_t node, old_joint;
};

// Takes the rig of a document away and brings the placed meshes to the top of their scenes, each on a node without a transform.
// What else hung from the old joints is taken out of the tree, in `attachments`. Animations of joints and of the transforms of mesh nodes
// go too, as do extensions that describe a rig (VRM). `changes` says what went. Nodes that are removed stay in the array, out of every
// tree, and are marked in `removed`: the numbers of the others hold until then.
struct Cleared {
  std::vector<std::size_t> mesh_nodes;  // one for each instance
  std::vector<bool> removed_nodes, removed_skins;
  std::vector<bool> scenes_with_mesh;
  std::vector<Attachment> attachments;
};
Cleared clear_rig(Document& document, const Scene& scene, const std::vector<PlacedInstance>& instances, std::vector<std::string>& changes);

}  // namespace osteon::io::gltf
