// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "osteon/io/gltf/writer.h"
#include "osteon/io/scene.h"

namespace osteon::io::gltf {

// The joints that a document has already, as io::joint_tree numbers them.
class OwnJoints {
 public:
  OwnJoints(const Scene& scene, std::vector<std::string>& repairs);

  // Gives the marked skins inverse bind matrices for vertices in the world that `to_world` leads to from the file's. Meshes outside the
  // scene, which nobody rewrites, keep the skin as it was, in a copy.
  void rebind(Writer& writer, Document& document, const std::vector<bool>& skins, const Eigen::Affine3d& to_world,
              std::vector<std::string>& changes);

  struct Places {
    std::size_t skin;               // in the document
    std::vector<JointId> of_joint;  // by JointId: its place in the skin; the first for a joint that the skin does not have
    std::size_t count;              // of joints in the skin
  };
  // The skin of an instance, or a new one that leaves it where it stands. Joints that are used and that the skin lacks are added behind the
  // others: nothing in front of them changes.
  Places complete(Writer& writer, Document& document, const Scene::Instance& instance, const std::vector<bool>& used,
                  std::vector<std::string>& changes) const;

 private:
  void leave_to_others(Document& document, std::size_t skin) const;

  Scene scene_;
  std::vector<std::optional<std::size_t>> node_of_;  // by JointId
};

}  // namespace osteon::io::gltf
