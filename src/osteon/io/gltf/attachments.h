// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/io/gltf/joint_nodes.h"
#include "osteon/io/gltf/old_rig.h"

namespace osteon::io::gltf {

// Hangs what the old joints carried under the new joints that are nearest to them, each where it was in the world. Between the two stands a
// node that takes the old parent's place: transforms of attachments, and animations of them, are relative to that and hold as they are.
// `scene` is the document's before its rig was cleared; `to_world` leads from its world to that of the new joints. `changes` names all.
void hang_attachments(Document& document, const Scene& scene, const Eigen::Affine3d& to_world, const std::vector<Attachment>& attachments,
                      const JointNodes& joints, std::vector<std::string>& changes);

}  // namespace osteon::io::gltf
