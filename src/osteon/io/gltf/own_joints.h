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
  OwnJoints(const Document& document, const Scene& scene, std::vector<std::string>& repairs);

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
  const Scene& scene_;
  std::vector<std::optional<std::size_t>> node_of_;  // by JointId
};

}  // namespace osteon::io::gltf
