// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/gltf/joint_nodes.h"

#include <algorithm>
#include <cmath>

#include "osteon/base/error.h"
#include "osteon/io/gltf/import.h"

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

// The joints, what stands above them and what hangs below.
std::vector<bool> around_joints(const Scene& scene, const SkeletonSource& skeleton) {
  std::vector<bool> wanted(scene.nodes.size(), false), is_joint(scene.nodes.size(), false);
  for (const auto& node : skeleton.node_of_joint) {
    if (node) is_joint[*node] = true;
    for (std::optional<std::size_t> n = node; n && !wanted[*n]; n = scene.nodes[*n].parent) wanted[*n] = true;
  }
  for (std::size_t leaf = 0; leaf < wanted.size(); ++leaf) {
    std::vector<std::size_t> path;
    for (std::optional<std::size_t> n = leaf; n; n = scene.nodes[*n].parent) {
      if (is_joint[*n])
        for (const std::size_t below : path) wanted[below] = true;
      path.push_back(*n);
    }
  }
  return wanted;
}

// With the children that the importer took for its own: no node is in two places.
Json stripped_node(const SkeletonSource& skeleton, const Scene& scene, std::size_t n, const std::vector<bool>& wanted,
                   const std::vector<std::size_t>& copy_of) {
  Json node = skeleton.document.json["nodes"][n];
  for (const char* key : {"mesh", "skin", "camera", "weights", "extensions"}) node.erase(key);
  if (!node.contains("children")) return node;
  Json children = Json::array();
  for (const Json& child : node["children"]) {
    const auto c = child.get<std::size_t>();
    if (wanted.at(c) && scene.nodes[c].parent == n && std::ranges::count(children, Json(copy_of[c])) == 0) children.push_back(copy_of[c]);
  }
  if (children.empty())
    node.erase("children");
  else
    node["children"] = std::move(children);
  return node;
}

}  // namespace

Json fitted_node(const std::string& name, const Eigen::Affine3d& fit, const std::vector<std::size_t>& children) {
  const double scale = std::cbrt(fit.linear().determinant());
  const Eigen::Quaternionf q = Eigen::Quaterniond(fit.linear() / scale).normalized().cast<float>();
  const Vec3f t = fit.translation().cast<float>();
  const auto s = static_cast<float>(scale);
  return Json{{"name", name},
              {"children", children},
              {"translation", {t.x(), t.y(), t.z()}},
              {"rotation", {q.x(), q.y(), q.z(), q.w()}},
              {"scale", {s, s, s}}};
}

JointNodes add_joint_nodes(Writer& writer, Document& document, const Skeleton& skeleton, const Eigen::Affine3d& bind, JointNames naming,
                           std::set<std::string> names, std::vector<std::string>& changes) {
  const std::vector<std::string> joint_names =
      naming == JointNames::portable ? portable_names(skeleton, std::move(names), changes) : skeleton.names.raw();
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
  JointNodes out{first, skins.size() - 1, {}};
  for (const JointId j : worlds.ids()) out.joints.push_back({first + index(j), worlds[j]});
  return out;
}

std::vector<JointId> places_in_skin(const SkeletonSource& skeleton) {
  std::vector<JointId> places;
  std::uint16_t next = 0;
  for (const auto& node : skeleton.node_of_joint) places.push_back(JointId{node ? next++ : std::uint16_t{0}});
  return places;
}

bool can_bind(const Scene& scene, const std::vector<std::optional<std::size_t>>& node_of_joint) {
  return std::ranges::all_of(node_of_joint, [&](const auto& n) { return !n || scene.nodes[*n].world.linear().fullPivLu().isInvertible(); });
}

bool can_copy_joint_nodes(const SkeletonSource& skeleton) {
  std::vector<std::string> told_at_load;
  return can_bind(import_scene(skeleton.document, told_at_load).scene, skeleton.node_of_joint);
}

JointNodes copy_joint_nodes(Writer& writer, Document& document, const SkeletonSource& skeleton, const Eigen::Affine3d& fit,
                            const Eigen::Affine3d& bind) {
  std::vector<std::string> told_at_load;
  const Scene scene = import_scene(skeleton.document, told_at_load).scene;
  const std::vector<bool> wanted = around_joints(scene, skeleton);
  std::vector<std::size_t> copy_of(scene.nodes.size());
  std::size_t next = document.count("nodes");
  for (std::size_t n = 0; n < wanted.size(); ++n)
    if (wanted[n]) copy_of[n] = next++;
  Json& nodes = document.json["nodes"];
  std::vector<std::size_t> roots;
  for (std::size_t n = 0; n < wanted.size(); ++n) {
    if (!wanted[n]) continue;
    nodes.push_back(stripped_node(skeleton, scene, n, wanted, copy_of));
    if (!scene.nodes[n].parent) roots.push_back(copy_of[n]);
  }
  const Eigen::Affine3d placed = fit * skeleton.to_world;
  std::size_t root = roots.front();
  Eigen::Affine3d above = Eigen::Affine3d::Identity();
  if (roots.size() > 1 || !placed.matrix().isIdentity(0.0)) {
    const Json node = fitted_node(skeleton.document.path.stem().string() + " fitted", placed, roots);
    nodes.push_back(node);
    above = local_transform(Element(node, "node"));
    root = nodes.size() - 1;
  }
  JointNodes out{root, document.count("skins"), {}};
  std::vector<float> inverse_binds;
  Json joints = Json::array();
  for (const auto& n : skeleton.node_of_joint) {
    if (!n) continue;
    joints.push_back(copy_of[*n]);
    out.joints.push_back({copy_of[*n], above * scene.nodes[*n].world});
    const Eigen::Matrix4f inverse = (out.joints.back().world.inverse() * bind).matrix().cast<float>();
    inverse_binds.insert(inverse_binds.end(), inverse.data(), inverse.data() + 16);
  }
  const std::size_t matrices = writer.vectors(inverse_binds, 16, Target::none);
  document.json["skins"].push_back(Json{{"inverseBindMatrices", matrices}, {"joints", joints}});
  return out;
}

}  // namespace osteon::io::gltf
