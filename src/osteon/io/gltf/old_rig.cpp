// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/gltf/old_rig.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

namespace osteon::io::gltf {
namespace {

bool is_transform(const std::string& path) { return path == "translation" || path == "rotation" || path == "scale"; }

void strip_transform(Json& node) {
  for (const char* key : {"matrix", "translation", "rotation", "scale"}) node.erase(key);
}

void set_list(Json& object, const char* key, const std::vector<std::size_t>& list) {
  if (list.empty())
    object.erase(key);
  else
    object[key] = list;
}

bool describes_rig(const std::string& extension) {
  return extension == "VRM" || (extension.starts_with("VRMC_") && !extension.starts_with("VRMC_materials_"));
}

// A camera, a mesh, a light or what else extensions know.
bool shows_something(const Json& node) {
  if (node.contains("camera") || node.contains("mesh")) return true;
  if (!node.contains("extensions")) return false;
  const auto extensions = node["extensions"].items();
  return std::any_of(extensions.begin(), extensions.end(), [](const auto& extension) { return !describes_rig(extension.key()); });
}

// 'one', 'two'; the number of those without a name.
std::string listed(const Json& animations, const std::vector<std::size_t>& which) {
  std::string out;
  for (const std::size_t a : which)
    out += fmt::format("{}'{}'", out.empty() ? "" : ", ", animations[a].value("name", fmt::format("animations[{}]", a)));
  return out;
}

class RigRemoval {
 public:
  RigRemoval(Document& document, const Scene& scene, const std::vector<PlacedInstance>& instances, std::vector<std::string>& changes)
      : json_(document.json), scene_(scene), instances_(instances), changes_(changes), nodes_(scene.nodes.size()) {}

  Cleared run() {
    find_tree();
    mark_old_skins();
    mark_joints();
    mark_removed();
    const std::vector<std::vector<std::size_t>> scenes = scenes_of_instances();
    std::map<std::size_t, std::size_t> moved_to;
    for (const PlacedInstance& placed : instances_) cleared_.mesh_nodes.push_back(move_mesh(placed.instance.node, moved_to));
    write_children();
    list_in_scenes(scenes);
    filter_animations(moved_to);
    if (cleared_.removed_skins != std::vector<bool>(cleared_.removed_skins.size())) drop_rig_extensions();
    return std::move(cleared_);
  }

 private:
  struct Node {
    std::vector<std::size_t> children;
    bool is_old_joint = false, is_kept_joint = false;
    bool has_mesh = false, had_children = false;
    bool is_attachment = false, holds_kept_joint = false;
  };

  // The tree as the importer took it: broken links left out, children in order, parents before children in order_.
  void find_tree() {
    std::vector<bool> taken(nodes_.size());
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      const Json& node = json_.at("nodes").at(n);
      if (node.contains("children"))
        for (const Json& child : node.at("children")) {
          const auto c = child.get<std::size_t>();
          if (scene_.nodes.at(c).parent != n || taken[c]) continue;
          taken[c] = true;
          nodes_[n].children.push_back(c);
        }
      nodes_[n].had_children = !nodes_[n].children.empty();
    }
    for (std::size_t n = 0; n < nodes_.size(); ++n)
      if (!scene_.nodes[n].parent) order_.push_back(n);
    for (std::size_t i = 0; i < order_.size(); ++i)
      order_.insert(order_.end(), nodes_[order_[i]].children.begin(), nodes_[order_[i]].children.end());
    for (const PlacedInstance& placed : instances_) nodes_[placed.instance.node].has_mesh = true;
    cleared_.removed_nodes.resize(nodes_.size());
  }

  // A skin stays only if a mesh outside the scene needs it.
  void mark_old_skins() {
    cleared_.removed_skins.assign(scene_.skins.size(), true);
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      const Json& node = json_["nodes"][n];
      if (node.contains("skin") && !nodes_[n].has_mesh) cleared_.removed_skins.at(node["skin"].get<std::size_t>()) = false;
    }
  }

  void mark_joints() {
    for (std::size_t s = 0; s < scene_.skins.size(); ++s)
      for (const std::size_t joint : scene_.skins[s].joints)
        (cleared_.removed_skins[s] ? nodes_[joint].is_old_joint : nodes_[joint].is_kept_joint) = true;
    for (Node& node : nodes_) node.is_old_joint = node.is_old_joint && !node.is_kept_joint;
    const auto joints = std::ranges::count_if(nodes_, [](const Node& node) { return node.is_old_joint; });
    if (joints > 0) changes_.push_back(fmt::format("replaced the rig that the asset had ({} joints)", joints));
  }

  // Old joints and what stood above them or above meshes and now holds nothing. What hung from old joints is taken out, children before
  // parents, but for the joints of skins that stay: these, and what stands above them, keep their place.
  void mark_removed() {
    for (std::size_t i = order_.size(); i-- > 0;) {
      const std::size_t n = order_[i];
      Node& node = nodes_[n];
      std::erase_if(node.children, [&](std::size_t c) { return cleared_.removed_nodes[c] || nodes_[c].is_attachment || moves(c); });
      node.holds_kept_joint =
          node.is_kept_joint || std::ranges::any_of(node.children, [&](std::size_t c) { return nodes_[c].holds_kept_joint; });
      const Json& json = json_["nodes"][n];
      const bool stays = node.has_mesh || shows_something(json) || !node.children.empty() || node.is_kept_joint ||
                         !(node.is_old_joint || (node.had_children && !json.contains("extras")));
      const std::optional<std::size_t> parent = scene_.nodes[n].parent;
      cleared_.removed_nodes[n] = !stays;
      node.is_attachment = stays && !moves(n) && !node.holds_kept_joint && (node.is_old_joint || (parent && nodes_[*parent].is_old_joint));
      if (node.is_attachment) cleared_.attachments.push_back({n, node.is_old_joint ? n : *parent});
    }
    std::ranges::reverse(cleared_.attachments);
  }

  // A mesh's own node goes to the top of the scene if nothing hangs below it; else a new node takes the mesh there. Children come before
  // parents in mark_removed(), so those of `node` are final.
  bool moves(std::size_t node) const { return nodes_[node].has_mesh && nodes_[node].children.empty(); }

  std::vector<std::vector<std::size_t>> scenes_of_instances() const {
    std::vector<std::vector<std::size_t>> out;
    for (const PlacedInstance& placed : instances_) {
      std::vector<std::size_t> path;
      for (std::optional<std::size_t> n = placed.instance.node; n; n = scene_.nodes[*n].parent) path.push_back(*n);
      out.emplace_back();
      if (!json_.contains("scenes")) continue;
      for (std::size_t s = 0; s < json_["scenes"].size(); ++s)
        if (json_["scenes"][s].contains("nodes"))
          for (const Json& root : json_["scenes"][s]["nodes"])
            if (std::find(path.begin(), path.end(), root.get<std::size_t>()) != path.end() &&
                (out.back().empty() || out.back().back() != s))
              out.back().push_back(s);
    }
    return out;
  }

  std::size_t move_mesh(std::size_t n, std::map<std::size_t, std::size_t>& moved_to) {
    Json& nodes = json_["nodes"];
    if (moves(n)) {
      strip_transform(nodes[n]);
      nodes[n].erase("skin");
      moved_to[n] = n;
      return n;
    }
    Json node = Json::object();
    for (const char* key : {"name", "mesh", "weights"})
      if (nodes[n].contains(key)) node[key] = nodes[n][key];
    for (const char* key : {"mesh", "skin", "weights"}) nodes[n].erase(key);
    nodes.push_back(std::move(node));
    cleared_.removed_nodes.push_back(false);
    return moved_to[n] = nodes.size() - 1;
  }

  void write_children() {
    for (const std::size_t n : order_) set_list(json_["nodes"][n], "children", nodes_[n].children);
  }

  void list_in_scenes(const std::vector<std::vector<std::size_t>>& scenes_of_instance) {
    if (!json_.contains("scenes")) {
      std::vector<std::size_t> roots;
      for (const std::size_t n : order_)
        if (!scene_.nodes[n].parent && !cleared_.removed_nodes[n] && !nodes_[n].is_attachment) roots.push_back(n);
      json_["scene"] = 0;
      json_["scenes"] = Json::array({Json{{"nodes", roots}}});
    }
    cleared_.scenes_with_mesh.resize(json_["scenes"].size());
    for (std::size_t s = 0; s < json_["scenes"].size(); ++s) {
      std::vector<std::size_t> roots = other_roots(json_["scenes"][s]);
      for (std::size_t i = 0; i < instances_.size(); ++i) {
        const auto& shown_in = scenes_of_instance[i];
        if (shown_in.empty() ? s != 0 : std::find(shown_in.begin(), shown_in.end(), s) == shown_in.end()) continue;
        cleared_.scenes_with_mesh[s] = true;
        roots.push_back(cleared_.mesh_nodes[i]);
      }
      set_list(json_["scenes"][s], "nodes", roots);
    }
  }

  // Meshes are listed behind the others in the order in which they were read, so that reading the result gives the same vertices again.
  std::vector<std::size_t> other_roots(const Json& scene) const {
    std::vector<std::size_t> roots;
    if (!scene.contains("nodes")) return roots;
    const auto& meshes = cleared_.mesh_nodes;
    for (const Json& root : scene["nodes"])
      if (const auto n = root.get<std::size_t>();
          !cleared_.removed_nodes.at(n) && !nodes_[n].is_attachment && std::find(meshes.begin(), meshes.end(), n) == meshes.end())
        roots.push_back(n);
    return roots;
  }

  // Channels that move what is gone, or what a skin ignores, go; the morph weights of a mesh follow it to its new node.
  void filter_animations(const std::map<std::size_t, std::size_t>& moved_to) {
    if (!json_.contains("animations")) return;
    Json kept_animations = Json::array();
    std::vector<std::size_t> cut, removed;
    for (std::size_t a = 0; a < json_["animations"].size(); ++a) {
      Json animation = json_["animations"][a];
      Json kept = Json::array();
      for (Json& channel : animation.at("channels")) {
        Json& target = channel.at("target");
        if (target.contains("node") && target["node"].is_number()) {
          const auto n = target["node"].get<std::size_t>();
          const bool transform = is_transform(target.value("path", ""));
          const auto mesh = moved_to.find(n);
          if (n >= nodes_.size() || cleared_.removed_nodes[n] ||
              (transform && (nodes_[n].is_old_joint || (mesh != moved_to.end() && mesh->second == n))))
            continue;
          if (!transform && mesh != moved_to.end()) target["node"] = mesh->second;
        }
        kept.push_back(channel);
      }
      if (kept.size() != animation["channels"].size()) (kept.empty() ? removed : cut).push_back(a);
      if (kept.empty()) continue;
      keep_used_samplers(animation, kept);
      kept_animations.push_back(std::move(animation));
    }
    if (!removed.empty())
      changes_.push_back(
          fmt::format("removed animations that moved only what the new rig moves now: {}", listed(json_["animations"], removed)));
    if (!cut.empty())
      changes_.push_back(fmt::format("removed from animations what the new rig moves now: {}", listed(json_["animations"], cut)));
    if (kept_animations.empty())
      json_.erase("animations");
    else
      json_["animations"] = std::move(kept_animations);
  }

  static void keep_used_samplers(Json& animation, Json& channels) {
    if (channels.size() == animation["channels"].size()) return;
    Json samplers = Json::array();
    std::map<std::size_t, std::size_t> renumbered;
    for (Json& channel : channels) {
      const auto old = channel.at("sampler").get<std::size_t>();
      const auto [entry, is_new] = renumbered.emplace(old, samplers.size());
      if (is_new) samplers.push_back(animation.at("samplers").at(old));
      channel["sampler"] = entry->second;
    }
    animation["samplers"] = std::move(samplers);
    animation["channels"] = std::move(channels);
  }

  void drop_rig_extensions() {
    const auto drop_from = [&](Json& object) {
      if (!object.is_object() || !object.contains("extensions")) return;
      Json kept = Json::object();
      for (auto& [name, value] : object["extensions"].items())
        if (!describes_rig(name)) kept[name] = value;
      if (kept.empty())
        object.erase("extensions");
      else
        object["extensions"] = std::move(kept);
    };
    drop_from(json_);
    for (Json& node : json_["nodes"]) drop_from(node);
    for (const char* key : {"extensionsUsed", "extensionsRequired"}) {
      if (!json_.contains(key)) continue;
      Json kept = Json::array();
      for (const Json& name : json_[key]) {
        if (!describes_rig(name.get<std::string>()))
          kept.push_back(name);
        else if (std::string_view(key) == "extensionsUsed")
          changes_.push_back(fmt::format("removed the extension {} of the rig that was replaced", name.get<std::string>()));
      }
      if (kept.empty())
        json_.erase(key);
      else
        json_[key] = std::move(kept);
    }
  }

  Json& json_;
  const Scene& scene_;
  const std::vector<PlacedInstance>& instances_;
  std::vector<std::string>& changes_;
  std::vector<Node> nodes_;
  std::vector<std::size_t> order_;
  Cleared cleared_;
};

}  // namespace

Cleared clear_rig(Document& document, const Scene& scene, const std::vector<PlacedInstance>& instances, std::vector<std::string>& changes) {
  return RigRemoval(document, scene, instances, changes).run();
}

}  // namespace osteon::io::gltf
