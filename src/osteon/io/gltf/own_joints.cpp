// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/gltf/own_joints.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>

#include "osteon/io/joint_tree.h"

namespace osteon::io::gltf {
namespace {

void append(std::vector<float>& matrices, const Eigen::Affine3d& matrix) {
  const Eigen::Matrix4f m = matrix.matrix().cast<float>();
  matrices.insert(matrices.end(), m.data(), m.data() + 16);
}

// The inverse bind matrices of a skin as they are in the file, one after the other.
std::vector<float> matrices_of(const Document& document, const Json& skin, std::size_t joints) {
  std::vector<float> out;
  if (skin.contains("inverseBindMatrices")) {
    out = Accessor(document, skin["inverseBindMatrices"].get<std::size_t>()).floats();
    out.resize(16 * joints);
  }
  while (out.size() < 16 * joints) append(out, Eigen::Affine3d::Identity());
  return out;
}

}  // namespace

OwnJoints::OwnJoints(const Scene& scene, std::vector<std::string>& repairs) : scene_(scene) {
  const auto tree = joint_tree(scene, repairs);
  assert(tree);
  node_of_ = nodes_of_joints(*tree, tree->skeleton.size());
}

void OwnJoints::rebind(Writer& writer, Document& document, const std::vector<bool>& skins, const Eigen::Affine3d& to_world,
                       std::vector<std::string>& changes) {
  for (std::size_t s = 0; s < skins.size(); ++s) {
    if (!skins[s]) continue;
    leave_to_others(document, s);
    std::vector<float> matrices;
    for (std::size_t j = 0; j < scene_.skins[s].joints.size(); ++j) {
      Eigen::Affine3d& inverse_bind = scene_.skins[s].inverse_binds[j];
      inverse_bind = scene_.nodes[scene_.skins[s].joints[j]].world.inverse() * to_world.inverse();
      append(matrices, inverse_bind);
    }
    document.json["skins"][s]["inverseBindMatrices"] = writer.vectors(matrices, 16, Target::none);
    changes.push_back(fmt::format("skin {} was not in its bind pose; its meshes are bound as they stand", s));
  }
}

void OwnJoints::leave_to_others(Document& document, std::size_t skin) const {
  Json& skins = document.json["skins"];
  std::optional<std::size_t> copy;
  for (std::size_t n = 0; n < scene_.nodes.size(); ++n) {
    Json& node = document.json["nodes"][n];
    if (!node.contains("skin") || node["skin"].get<std::size_t>() != skin) continue;
    if (std::ranges::any_of(scene_.instances, [&](const Scene::Instance& instance) { return instance.node == n; })) continue;
    if (!copy) {
      copy = skins.size();
      skins.push_back(Json(skins[skin]));
    }
    node["skin"] = *copy;
  }
}

OwnJoints::Places OwnJoints::complete(Writer& writer, Document& document, const Scene::Instance& instance, const std::vector<bool>& used,
                                      std::vector<std::string>& changes) const {
  Json& skins = document.json["skins"];
  std::vector<std::size_t> joints;
  Eigen::Affine3d to_world = scene_.nodes[instance.node].world;
  if (instance.skin) {
    joints = skins[*instance.skin]["joints"].get<std::vector<std::size_t>>();
    const Scene::Skin& skin = scene_.skins[*instance.skin];
    to_world = scene_.nodes[skin.joints[0]].world * skin.inverse_binds[0];
  } else {
    changes.push_back(fmt::format("the mesh of node '{}' was not skinned; it is now", scene_.nodes[instance.node].name));
    skins.push_back(Json{{"joints", Json::array()}});
  }
  Places places{instance.skin.value_or(skins.size() - 1), std::vector<JointId>(node_of_.size(), JointId{0}), 0};
  Json& skin = skins[places.skin];
  std::vector<float> matrices = matrices_of(document, skin, joints.size());
  const std::size_t before = joints.size();
  for (std::size_t j = 0; j < used.size(); ++j)
    if (used[j] && node_of_[j] && std::ranges::find(joints, *node_of_[j]) == joints.end()) {
      joints.push_back(*node_of_[j]);
      append(matrices, scene_.nodes[*node_of_[j]].world.inverse() * to_world);
    }
  if (joints.size() > before) {
    if (instance.skin) changes.push_back(fmt::format("skin {} got {} more joints at its end", *instance.skin, joints.size() - before));
    skin["joints"] = joints;
    skin["inverseBindMatrices"] = writer.vectors(matrices, 16, Target::none);
  }
  for (std::size_t j = 0; j < node_of_.size(); ++j)
    if (node_of_[j])
      if (const auto at = std::ranges::find(joints, *node_of_[j]); at != joints.end())
        places.of_joint[j] = static_cast<JointId>(at - joints.begin());
  places.count = joints.size();
  return places;
}

}  // namespace osteon::io::gltf
