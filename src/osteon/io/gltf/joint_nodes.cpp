// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/gltf/joint_nodes.h"

#include "osteon/base/error.h"

namespace osteon::io::gltf {
namespace {

std::string portable_name(const std::string& name) {
  std::string out;
  for (std::size_t i = 0; i < name.size(); ++i) {
    const auto c = static_cast<unsigned char>(name[i]);
    const bool continues = c >= 0x80 && c < 0xC0;  // of a UTF-8 character: one '_' for all of its bytes
    if (!continues) out += c < 0x20 || c >= 0x7F || c == ':' || c == '/' || c == '\\' || c == '"' ? '_' : static_cast<char>(c);
  }
  return out.empty() ? "joint" : out;
}

std::vector<std::string> portable_names(const Skeleton& skeleton, std::set<std::string> taken, std::vector<std::string>& changes) {
  std::vector<std::string> names;
  for (const std::string& wanted : skeleton.names) {
    const std::string name = portable_name(wanted);
    std::string candidate = name;
    for (int n = 1; !taken.insert(candidate).second; ++n) candidate = fmt::format("{}_{}", name, n);
    if (candidate != wanted) changes.push_back(fmt::format("joint '{}' is named '{}' in the GLB", wanted, candidate));
    names.push_back(candidate);
  }
  return names;
}

Eigen::Affine3d rest_transform(const Skeleton& skeleton, JointId j) {
  return Eigen::Translation3d(skeleton.rest_positions[j].cast<double>()) * skeleton.rest_orientations[j].cast<double>().normalized();
}

// What a reader of the file computes: the node's numbers are floats.
struct Local {
  Vec3f translation;
  Quatf rotation;

  explicit Local(const Eigen::Affine3d& m) : translation(m.translation().cast<float>()) {
    Eigen::Quaterniond q(m.linear());
    q.normalize();
    if (q.w() < 0.0) q.coeffs() = -q.coeffs();  // one of two spellings, so that equal rotations give equal bytes
    rotation = q.cast<float>();
  }
  Eigen::Affine3d transform() const { return Eigen::Translation3d(translation.cast<double>()) * rotation.cast<double>().normalized(); }
  Json node(const std::string& name) const {
    Json node{{"name", name}};
    if (!translation.isZero(0.0f)) node["translation"] = {translation.x(), translation.y(), translation.z()};
    if (!rotation.vec().isZero(0.0f)) node["rotation"] = {rotation.x(), rotation.y(), rotation.z(), rotation.w()};
    return node;
  }
};

}  // namespace

JointNodes add_joint_nodes(Writer& writer, Document& document, const Skeleton& skeleton, const Eigen::Affine3d& bind,
                           std::set<std::string> names, std::vector<std::string>& changes) {
  const std::vector<std::string> joint_names = portable_names(skeleton, std::move(names), changes);
  const std::size_t first = document.count("nodes");
  PerJoint<Eigen::Affine3d> worlds;  // as the file has them: errors of rounding do not add up along a chain
  std::vector<float> inverse_binds;
  std::vector<Json> nodes;
  Json joints = Json::array();
  for (const JointId j : ids<JointId>(skeleton.size())) {
    const auto parent = skeleton.parents[j];
    const Eigen::Affine3d above = parent ? worlds[*parent] : Eigen::Affine3d::Identity();
    const Local local(above.inverse() * rest_transform(skeleton, j));
    worlds.push_back(above * local.transform());
    nodes.push_back(local.node(joint_names[index(j)]));
    if (parent) nodes[index(*parent)]["children"].push_back(first + index(j));
    joints.push_back(first + index(j));
    const Eigen::Matrix4f inverse = (worlds[j].inverse() * bind).matrix().cast<float>();
    inverse_binds.insert(inverse_binds.end(), inverse.data(), inverse.data() + 16);
  }
  Json& all = document.json["nodes"];
  for (Json& node : nodes) all.push_back(std::move(node));
  const std::size_t matrices = writer.vectors(inverse_binds, 16, Target::none);
  Json& skins = document.json["skins"];
  skins.push_back(Json{{"inverseBindMatrices", matrices}, {"joints", joints}, {"skeleton", first}});
  return {first, skins.size() - 1};
}

}  // namespace osteon::io::gltf
