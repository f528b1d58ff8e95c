// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/gltf/import.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "osteon/base/error.h"
#include "osteon/io/gltf/accessor.h"

namespace osteon::io::gltf {
namespace {

// Node transforms --------------------------------------------------------------------------------------------------------------------

std::vector<std::size_t> parentless(const std::vector<Element>& nodes) {
  std::vector<bool> is_child(nodes.size());
  for (const Element& node : nodes)
    for (const auto& list = node.find("children"); const Element& child : list ? list->items() : std::vector<Element>{})
      is_child[child.index(nodes.size(), "nodes")] = true;
  std::vector<std::size_t> roots;
  for (std::size_t n = 0; n < nodes.size(); ++n)
    if (!is_child[n]) roots.push_back(n);
  return roots;
}

std::vector<std::size_t> root_nodes(const Document& document, const std::vector<Element>& nodes) {
  std::vector<std::size_t> roots;
  if (const std::size_t scenes = document.count("scenes"); scenes > 0) {
    const auto chosen = document.root().find("scene");
    const Element scene = document.at("scenes", chosen ? chosen->index(scenes, "scenes") : 0);
    const auto listed = scene.find("nodes");
    for (const Element& item : listed ? listed->items() : std::vector<Element>{}) roots.push_back(item.index(nodes.size(), "nodes"));
    return roots;
  }
  return parentless(nodes);
}

// Fills scene.nodes from the roots down. A node met twice (a cycle, or two parents) keeps its first place.
class TreeWalk {
 public:
  TreeWalk(std::vector<Element> nodes, Scene& scene, std::vector<std::string>& repairs)
      : nodes_(std::move(nodes)), scene_(scene), repairs_(repairs), placed_(nodes_.size()) {
    scene.nodes.resize(nodes_.size());
  }

  // Returns the nodes below and with `roots`, parents before children.
  std::vector<std::size_t> visit(const std::vector<std::size_t>& roots) {
    std::vector<std::size_t> order, pending;
    for (std::size_t r = roots.size(); r-- > 0;)
      if (!placed_[roots[r]]) {
        placed_[roots[r]] = true;
        pending.push_back(roots[r]);
      }
    while (!pending.empty()) {
      order.push_back(pending.back());
      pending.pop_back();
      place(order.back());
      push_children(order.back(), pending);
    }
    return order;
  }

 private:
  void place(std::size_t n) {
    Scene::Node& node = scene_.nodes[n];
    node.name = nodes_[n].text_or("name", "");
    node.world = (node.parent ? scene_.nodes[*node.parent].world : Eigen::Affine3d::Identity()) * local_transform(nodes_[n]);
  }

  void push_children(std::size_t n, std::vector<std::size_t>& pending) {
    const auto list = nodes_[n].find("children");
    const auto children = list ? list->items() : std::vector<Element>{};
    for (std::size_t c = children.size(); c-- > 0;) {
      const std::size_t child = children[c].index(nodes_.size(), "nodes");
      if (placed_[child]) {
        repairs_.push_back(fmt::format("{}: node {} has another place in the tree already; ignored", children[c].where(), child));
        continue;
      }
      placed_[child] = true;
      scene_.nodes[child].parent = n;
      pending.push_back(child);
    }
  }

  std::vector<Element> nodes_;
  Scene& scene_;
  std::vector<std::string>& repairs_;
  std::vector<bool> placed_;
};

// Places all nodes and returns those of the default scene. Joints may stand outside of it, so the others are placed too.
std::vector<std::size_t> place_nodes(const Document& document, Scene& scene, std::vector<std::string>& repairs) {
  const std::vector<Element> nodes = document.all("nodes");
  TreeWalk walk(nodes, scene, repairs);
  const std::vector<std::size_t> order = walk.visit(root_nodes(document, nodes));
  walk.visit(parentless(nodes));
  return order;
}

// Meshes -----------------------------------------------------------------------------------------------------------------------------

// Corners of triangles, three by three, from a list of vertices in primitive mode 4, 5 or 6 (specification, section 3.7.2.1).
std::vector<std::uint32_t> unroll(std::vector<std::uint32_t> corners, std::size_t mode) {
  if (mode == 4) {
    corners.resize(corners.size() / 3 * 3);
    return corners;
  }
  std::vector<std::uint32_t> out;
  for (std::size_t i = 0; i + 2 < corners.size(); ++i) {
    if (mode == 5)
      out.insert(out.end(), {corners[i], corners[i + 1 + i % 2], corners[i + 2 - i % 2]});
    else
      out.insert(out.end(), {corners[i + 1], corners[i + 2], corners[0]});
  }
  return out;
}

// JOINTS_n and WEIGHTS_n of one vertex block, every n.
void read_influences(const Document& document, const Element& attributes, const MeshLayout::Block& block, Scene::Mesh& mesh) {
  std::vector<std::vector<std::uint32_t>> joints;
  std::vector<std::vector<float>> weights;
  for (int set = 0;; ++set) {
    const auto joints_at = attributes.find(fmt::format("JOINTS_{}", set)), weights_at = attributes.find(fmt::format("WEIGHTS_{}", set));
    if (!joints_at || !weights_at) break;
    const std::size_t accessors = document.count("accessors");
    const Accessor joint(document, joints_at->index(accessors, "accessors")), weight(document, weights_at->index(accessors, "accessors"));
    for (const Accessor* a : {&joint, &weight})
      if (a->count() != block.count || a->components() != 4)
        throw Error("{}: {} elements of {} values, expected {} of 4", a->where(), a->count(), a->components(), block.count);
    joints.push_back(joint.integers());
    weights.push_back(weight.floats());
  }
  for (std::size_t v = 0; v < block.count; ++v) {
    for (std::size_t set = 0; set < joints.size(); ++set)
      for (std::size_t k = 4 * v; k < 4 * v + 4; ++k)
        if (weights[set][k] > 0.0f && std::isfinite(weights[set][k])) mesh.influences.push_back({joints[set][k], weights[set][k]});
    mesh.influence_offsets.push_back(static_cast<std::uint32_t>(mesh.influences.size()));
  }
}

// The block of a primitive's vertices, read into the mesh unless another primitive did so before; empty if it has none.
std::optional<std::size_t> read_block(const Document& document, const Element& primitive, MeshLayout& layout, Scene::Mesh& mesh,
                                      std::vector<std::string>& repairs) {
  const Element attributes = primitive.at("attributes");
  const auto position = attributes.find("POSITION");
  if (!position) {
    repairs.push_back(fmt::format("{}: no POSITION; left out", primitive.where()));
    return std::nullopt;
  }
  const std::size_t accessor = position->index(document.count("accessors"), "accessors");
  for (std::size_t b = 0; b < layout.blocks.size(); ++b)
    if (layout.blocks[b].accessor == accessor) return b;
  const Accessor positions(document, accessor);
  if (positions.components() != 3) throw Error("{}: {} components, expected 3 for POSITION", positions.where(), positions.components());
  if (mesh.positions.size() + positions.count() > kMostElements)
    throw Error("{}: more than {} vertices in one mesh", positions.where(), kMostElements);
  const std::size_t first = mesh.positions.size();
  const std::vector<float> values = positions.floats();
  mesh.positions.resize(first + positions.count());
  if (!values.empty()) std::copy(values.begin(), values.end(), mesh.positions[first].data());
  const std::size_t repaired = repair_positions(std::span(mesh.positions).subspan(first));
  if (repaired > 0)
    repairs.push_back(fmt::format("{}: moved {} vertices with coordinates that are not finite to the origin", positions.where(), repaired));
  layout.blocks.push_back({accessor, first, positions.count(), repaired > 0});
  read_influences(document, attributes, layout.blocks.back(), mesh);
  return layout.blocks.size() - 1;
}

std::vector<std::uint32_t> read_corners(const Document& document, const Element& primitive, std::size_t vertices) {
  if (const auto indices = primitive.find("indices")) {
    const Accessor accessor(document, indices->index(document.count("accessors"), "accessors"));
    if (accessor.components() != 1) throw Error("{}: {} components, expected 1 for indices", accessor.where(), accessor.components());
    return accessor.integers();
  }
  std::vector<std::uint32_t> all(vertices);
  std::iota(all.begin(), all.end(), 0u);
  return all;
}

void read_faces(const Document& document, const Element& primitive, const MeshLayout::Block& block, MeshLayout::Primitive& placed,
                Scene::Mesh& mesh, std::vector<std::string>& repairs) {
  const std::size_t mode = primitive.integer_or("mode", 4);
  if (mode > 6) throw Error("{}.mode: {}, expected 0 to 6", primitive.where(), mode);
  if (mode < 4) return;  // points and lines have vertices to be moved, but no faces
  const auto corners = unroll(read_corners(document, primitive, block.count), mode);
  const std::size_t before = mesh.faces.size();
  if (before + corners.size() / 3 > kMostElements) throw Error("{}: more than {} faces in one mesh", primitive.where(), kMostElements);
  for (std::size_t i = 0; i < corners.size(); i += 3) {
    if (corners[i] >= block.count || corners[i + 1] >= block.count || corners[i + 2] >= block.count) continue;
    const auto vertex = [&](std::size_t k) { return static_cast<VertexId>(block.first + corners[i + k]); };
    mesh.faces.push_back({vertex(0), vertex(1), vertex(2)});
  }
  const std::size_t dropped = corners.size() / 3 - (mesh.faces.size() - before);
  placed.first_face = before;
  placed.face_count = mesh.faces.size() - before;
  placed.faces_dropped = dropped > 0;
  if (dropped > 0)
    repairs.push_back(fmt::format("{}: dropped {} faces with an index beyond its {} vertices", primitive.where(), dropped, block.count));
}

void read_mesh(const Document& document, std::size_t m, Imported& imported, std::vector<std::string>& repairs) {
  Scene::Mesh& mesh = imported.scene.meshes[m];
  MeshLayout& layout = imported.layouts[m];
  mesh.influence_offsets = {0};
  for (const Element& primitive : document.at("meshes", m).at("primitives").items()) {
    if (const auto extensions = primitive.find("extensions"); extensions && extensions->find("KHR_draco_mesh_compression"))
      throw Error("{}: KHR_draco_mesh_compression: compressed vertices cannot be read; save the asset without compression",
                  primitive.where());
    layout.primitives.emplace_back();
    layout.primitives.back().block = read_block(document, primitive, layout, mesh, repairs);
    if (const auto block = layout.primitives.back().block)
      read_faces(document, primitive, layout.blocks[*block], layout.primitives.back(), mesh, repairs);
  }
  if (mesh.influences.empty()) mesh.influence_offsets.clear();
}

// Skins ------------------------------------------------------------------------------------------------------------------------------

Scene::Skin read_skin(const Document& document, const Element& element) {
  Scene::Skin skin;
  for (const Element& joint : element.at("joints").items()) skin.joints.push_back(joint.index(document.count("nodes"), "nodes"));
  skin.inverse_binds.assign(skin.joints.size(), Eigen::Affine3d::Identity());
  const auto matrices = element.find("inverseBindMatrices");
  if (!matrices) return skin;
  const Accessor accessor(document, matrices->index(document.count("accessors"), "accessors"));
  if (accessor.components() != 16 || accessor.count() < skin.joints.size())
    throw Error("{}: {} elements of {} values, expected {} of 16", accessor.where(), accessor.count(), accessor.components(),
                skin.joints.size());
  const std::vector<float> values = accessor.floats();
  for (std::size_t j = 0; j < skin.joints.size(); ++j) {
    const Eigen::Matrix4f matrix = Eigen::Map<const Eigen::Matrix4f>(values.data() + 16 * j);
    if (!matrix.allFinite()) throw Error("{}: matrix {} is not finite", accessor.where(), j);
    skin.inverse_binds[j].matrix() = matrix.cast<double>();
    skin.inverse_binds[j].makeAffine();
  }
  return skin;
}

}  // namespace

Eigen::Affine3d local_transform(const Element& node) {
  Eigen::Affine3d local = Eigen::Affine3d::Identity();
  if (const auto matrix = node.find("matrix")) {
    local.matrix() = Eigen::Map<const Eigen::Matrix4d>(matrix->numbers<16>().data());
    local.makeAffine();
    return local;
  }
  if (const auto t = node.find("translation")) local.translate(Eigen::Map<const Eigen::Vector3d>(t->numbers<3>().data()));
  if (const auto r = node.find("rotation")) {
    const auto [x, y, z, w] = r->numbers<4>();
    const Eigen::Quaterniond rotation(w, x, y, z);
    if (rotation.norm() < 1e-6) throw Error("{}: zero, expected a unit quaternion", r->where());
    local.rotate(rotation.normalized());
  }
  if (const auto s = node.find("scale")) local.scale(Eigen::Map<const Eigen::Vector3d>(s->numbers<3>().data()));
  return local;
}

Imported import_scene(const Document& document, std::vector<std::string>& repairs) {
  Imported imported;
  Scene& scene = imported.scene;
  scene.meshes.resize(document.count("meshes"));
  imported.layouts.resize(scene.meshes.size());
  const std::vector<std::size_t> order = place_nodes(document, scene, repairs);
  for (const Element& skin : document.all("skins")) scene.skins.push_back(read_skin(document, skin));
  std::vector<bool> read(scene.meshes.size());
  for (const std::size_t n : order) {
    const Element node = document.at("nodes", n);
    const auto mesh = node.find("mesh");
    if (!mesh) continue;
    Scene::Instance instance{n, mesh->index(scene.meshes.size(), "meshes"), std::nullopt};
    if (const auto skin = node.find("skin")) instance.skin = skin->index(scene.skins.size(), "skins");
    if (!read[instance.mesh]) read_mesh(document, instance.mesh, imported, repairs);
    read[instance.mesh] = true;
    scene.instances.push_back(instance);
  }
  return imported;
}

}  // namespace osteon::io::gltf
