// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/gltf/world.h"

#include "osteon/io/gltf/joint_nodes.h"

namespace osteon::io::gltf {

void bring_to_world(Document& document, const Scene& scene, const Eigen::Affine3d& to_world) {
  Json& nodes = document.json["nodes"];
  std::vector<std::size_t> top(scene.nodes.size());  // what each node is replaced by in the lists of scenes
  for (std::size_t n = 0; n < top.size(); ++n) {
    top[n] = n;
    if (scene.nodes[n].parent || (nodes[n].contains("skin") && !nodes[n].contains("children"))) continue;
    top[n] = nodes.size();
    nodes.push_back(fitted_node(scene.nodes[n].name + " fitted", to_world, {n}));
  }
  if (!document.json.contains("scenes")) return;
  for (Json& shown : document.json["scenes"])
    if (shown.contains("nodes"))
      for (Json& root : shown["nodes"]) root = top.at(root.get<std::size_t>());
}

}  // namespace osteon::io::gltf
