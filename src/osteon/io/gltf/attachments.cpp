// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/gltf/attachments.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace osteon::io::gltf {
namespace {

const JointNodes::Joint& nearest(const JointNodes& joints, const Eigen::Vector3d& place) {
  return *std::ranges::min_element(joints.joints, {}, [&](const auto& joint) { return (joint.world.translation() - place).squaredNorm(); });
}

}  // namespace

void hang_attachments(Document& document, const Scene& scene, const Eigen::Affine3d& to_world, const std::vector<Attachment>& attachments,
                      const JointNodes& joints, std::vector<std::string>& changes) {
  Json& nodes = document.json["nodes"];
  std::map<std::pair<std::size_t, std::optional<std::size_t>>, std::size_t> stand_ins;  // (new joint, old parent) -> node
  std::string hung;
  for (const Attachment& attachment : attachments) {
    const JointNodes::Joint& joint = nearest(joints, to_world * scene.nodes[attachment.old_joint].world.translation());
    const std::optional<std::size_t> parent = scene.nodes[attachment.node].parent;
    const auto [stand_in, is_new] = stand_ins.emplace(std::pair(joint.node, parent), nodes.size());
    if (is_new) {
      const Eigen::Affine3d world = to_world * (parent ? scene.nodes[*parent].world : Eigen::Affine3d::Identity());
      const Eigen::Matrix4f matrix = (joint.world.inverse() * world).matrix().cast<float>();
      nodes.push_back(Json{{"name", parent ? scene.nodes[*parent].name + " attachments" : "attachments"},
                           {"matrix", std::vector<float>(matrix.data(), matrix.data() + 16)}});
      nodes[joint.node]["children"].push_back(stand_in->second);
    }
    nodes[stand_in->second]["children"].push_back(attachment.node);
    hung += fmt::format("{}'{}' (now under '{}')", hung.empty() ? "" : ", ", scene.nodes[attachment.node].name,
                        nodes[joint.node].value("name", ""));
  }
  if (!hung.empty()) changes.push_back(fmt::format("hung what the replaced joints carried under the nearest new ones: {}", hung));
}

}  // namespace osteon::io::gltf
