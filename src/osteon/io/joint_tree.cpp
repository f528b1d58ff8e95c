// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/joint_tree.h"

#include <algorithm>
#include <set>

#include "osteon/base/error.h"

namespace osteon::io {
namespace {

constexpr std::size_t kMostJoints = 65535;  // JOINTS_n of glTF has 16 bits

// Distinct joints in order of the skins.
std::vector<std::size_t> joint_nodes(const Scene& scene) {
  std::vector<std::size_t> nodes;
  std::vector<bool> seen(scene.nodes.size());
  for (const Scene::Skin& skin : scene.skins)
    for (const std::size_t n : skin.joints)
      if (!seen[n]) {
        seen[n] = true;
        nodes.push_back(n);
      }
  return nodes;
}

std::optional<std::size_t> parent_joint(const Scene& scene, const std::vector<bool>& is_joint, std::size_t node) {
  for (auto n = scene.nodes[node].parent; n; n = scene.nodes[*n].parent)
    if (is_joint[*n]) return n;
  return std::nullopt;
}

// The nodes from `node` up to the top, itself included.
std::vector<std::size_t> path_up(const Scene& scene, std::size_t node) {
  std::vector<std::size_t> path;
  for (std::optional<std::size_t> n = node; n; n = scene.nodes[*n].parent) path.push_back(*n);
  return path;
}

std::optional<std::size_t> common_ancestor(const Scene& scene, const std::vector<std::size_t>& nodes) {
  std::vector<std::size_t> shared = path_up(scene, nodes[0]);
  for (const std::size_t n : nodes) {
    const std::vector<std::size_t> path = path_up(scene, n);
    const std::set<std::size_t> above(path.begin(), path.end());
    std::erase_if(shared, [&](std::size_t s) { return !above.contains(s); });
  }
  if (shared.empty()) return std::nullopt;
  return shared.front();
}

class TreeBuilder {
 public:
  TreeBuilder(const Scene& scene, std::vector<std::string>& repairs) : scene_(scene), repairs_(repairs), is_joint_(scene.nodes.size()) {
    tree_.joint_of_node.resize(scene.nodes.size());
  }

  std::optional<JointTree> build(const std::vector<std::size_t>& nodes) {
    if (nodes.empty()) return std::nullopt;
    if (nodes.size() > kMostJoints - 1) throw Error("{} joints, expected at most {}", nodes.size(), kMostJoints - 1);
    for (const std::size_t n : nodes) is_joint_[n] = true;
    add_root(nodes);
    for (const std::size_t n : nodes) add_with_parents(n);
    if (renamed_ > 0) repairs_.push_back(fmt::format("{} joints had no name, or that of another joint; renamed", renamed_));
    if (flat_ > 0) repairs_.push_back(fmt::format("{} joints have a singular transform; their axes are a guess", flat_));
    return std::move(tree_);
  }

 private:
  void add_root(const std::vector<std::size_t>& nodes) {
    std::vector<std::size_t> roots;
    for (const std::size_t n : nodes)
      if (!parent_joint(scene_, is_joint_, n)) roots.push_back(n);
    if (roots.size() == 1) return add_joint(roots[0], std::nullopt);
    if (const auto ancestor = common_ancestor(scene_, roots)) {
      repairs_.push_back(fmt::format("{} root joints; joined under the node '{}' above them", roots.size(), scene_.nodes[*ancestor].name));
      is_joint_[*ancestor] = true;
      return add_joint(*ancestor, std::nullopt);
    }
    repairs_.push_back(fmt::format("{} root joints; joined under a new one", roots.size()));
    Vec3f middle = Vec3f::Zero();
    for (const std::size_t n : roots) middle += position(n) / static_cast<float>(roots.size());
    tree_.skeleton.add(unique_name("root"), std::nullopt, middle);
  }

  // Chains can be long: no recursion.
  void add_with_parents(std::size_t node) {
    std::vector<std::size_t> missing;
    std::optional<std::size_t> n = node;
    for (; n && !tree_.joint_of_node[*n]; n = parent_joint(scene_, is_joint_, *n)) missing.push_back(*n);
    JointId parent = n ? *tree_.joint_of_node[*n] : JointId{0};
    for (; !missing.empty(); missing.pop_back()) {
      add_joint(missing.back(), parent);
      parent = *tree_.joint_of_node[missing.back()];
    }
  }

  void add_joint(std::size_t node, std::optional<JointId> parent) {
    tree_.joint_of_node[node] = tree_.skeleton.add(unique_name(scene_.nodes[node].name), parent, position(node), orientation(node));
  }

  Vec3f position(std::size_t node) {
    const Eigen::Vector3d p = scene_.nodes[node].world.translation();
    if (!(p.cwiseAbs().maxCoeff() <= static_cast<double>(kLargestCoordinate)))
      throw Error("joint '{}' is at ({}, {}, {}), expected at most {:g} from the origin", scene_.nodes[node].name, p.x(), p.y(), p.z(),
                  kLargestCoordinate);
    return p.cast<float>();
  }

  Quatf orientation(std::size_t node) {
    Eigen::Matrix3d axes = scene_.nodes[node].world.linear();
    for (int c = 0; c < 3; ++c) axes.col(c).normalize();
    if (!axes.allFinite() || std::abs(axes.determinant()) < 1e-6) {
      ++flat_;
      return Quatf::Identity();
    }
    const Eigen::Quaterniond q(Eigen::Affine3d(axes).rotation());
    return q.normalized().cast<float>().normalized();
  }

  std::string unique_name(std::string name) {
    const bool unnamed = name.empty();
    if (unnamed) name = "joint";
    std::string candidate = name;
    for (int n = 1; !taken_.insert(candidate).second; ++n) candidate = fmt::format("{}_{}", name, n);
    if (unnamed || candidate != name) ++renamed_;
    return candidate;
  }

  const Scene& scene_;
  std::vector<std::string>& repairs_;
  std::vector<bool> is_joint_;
  std::set<std::string> taken_;
  std::size_t renamed_ = 0, flat_ = 0;
  JointTree tree_;
};

}  // namespace

std::vector<std::optional<std::size_t>> nodes_of_joints(const JointTree& tree, std::size_t joints) {
  std::vector<std::optional<std::size_t>> nodes(joints);
  for (std::size_t n = 0; n < tree.joint_of_node.size(); ++n)
    if (const auto& joint = tree.joint_of_node[n]) nodes[index(*joint)] = n;
  return nodes;
}

std::optional<JointTree> joint_tree(const Scene& scene, std::vector<std::string>& repairs) {
  return TreeBuilder(scene, repairs).build(joint_nodes(scene));
}

std::optional<JointTree> joint_tree_of_nodes(const Scene& scene, std::vector<std::string>& repairs) {
  std::vector<bool> shows_mesh(scene.nodes.size());
  for (const Scene::Instance& instance : scene.instances) shows_mesh[instance.node] = true;
  std::vector<std::size_t> nodes;
  for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
    const bool container = !scene.nodes[n].parent && (scene.nodes[n].name == "RootNode" || scene.nodes[n].name == "Scene");  // FBX, DAE
    if (!shows_mesh[n] && !container) nodes.push_back(n);
  }
  return TreeBuilder(scene, repairs).build(nodes);
}

}  // namespace osteon::io
