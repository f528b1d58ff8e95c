// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/gltf/attach_rig.h"

#include <algorithm>

#include "osteon/base/error.h"
#include "osteon/io/gltf/attachments.h"
#include "osteon/io/gltf/bake.h"
#include "osteon/io/gltf/import.h"
#include "osteon/io/gltf/joint_nodes.h"
#include "osteon/io/gltf/old_rig.h"
#include "osteon/io/gltf/own_joints.h"
#include "osteon/io/gltf/references.h"
#include "osteon/io/gltf/single_buffer.h"
#include "osteon/io/gltf/skin_attributes.h"
#include "osteon/io/gltf/world.h"
#include "osteon/io/joint_tree.h"

namespace osteon::io::gltf {
namespace {

bool is_similarity(const Eigen::Affine3d& transform) {
  const Eigen::Matrix3d m = transform.linear();
  const double scale = std::cbrt(m.determinant());
  return scale > 1e-9 && (m.transpose() * m / (scale * scale) - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < 1e-5;
}

// The transform that the inverse bind matrices can take up for all meshes. Empty: some must be rewritten in world space. Mirrored and
// unevenly scaled ones are rewritten too, as many viewers turn neither faces nor normals for them.
std::optional<Eigen::Affine3d> shared_transform(const std::vector<PlacedInstance>& instances, Vertices vertices) {
  const std::optional<Eigen::Affine3d> shared = instances.front().to_world;
  if (!shared || !is_similarity(*shared)) return std::nullopt;
  if (vertices == Vertices::bake && !shared->matrix().isIdentity(0.0)) return std::nullopt;
  for (const PlacedInstance& placed : instances) {
    if (!placed.to_world || !placed.to_world->isApprox(*shared, 1e-12)) return std::nullopt;
  }
  return shared;
}

SkinWeights renumbered(const SkinWeights& weights, const std::vector<JointId>& number) {
  SkinWeights out;
  std::vector<Influence> row;
  for (const VertexId v : ids<VertexId>(weights.size())) {
    row.assign(weights[v].begin(), weights[v].end());
    for (Influence& i : row) i.joint = number[index(i.joint)];
    out.append(row);
  }
  return out;
}

class RigAttachment {
 public:
  RigAttachment(GltfSource& source, const std::vector<PlacedInstance>& instances, const TriangleMesh& mesh, const Skeleton& skeleton,
                const SkinWeights& weights, const SaveOptions& options, std::vector<std::string>& changes)
      : source_(source),
        document_(source.document),
        instances_(instances),
        mesh_(mesh),
        skeleton_(skeleton),
        weights_(weights),
        options_(options),
        changes_(changes),
        joint_count_(skeleton.size()) {}

  // Where the joints come from, if not from `skeleton`.
  void use_nodes_of(const SkeletonSource& joints, const Eigen::Affine3d& fit) {
    nodes_of_ = &joints;
    fit_ = fit;
    weights_ = renumbered(weights_, places_in_skin(joints));
  }

  // The joints and all else stay as they are.
  void run_with_own_joints() {
    join_buffers(document_, changes_);
    const Usage before = usage();
    std::vector<std::string> told_at_load;
    const Scene scene = import_scene(document_, told_at_load).scene;
    OwnJoints joints(scene, told_at_load);
    const SkinWeights all = weights_;
    Writer writer(document_);
    const std::vector<bool> rebound = skins_out_of_pose(scene);
    joints.rebind(writer, document_, rebound, source_.to_world, changes_);
    for (std::size_t i = 0; i < instances_.size(); ++i) {
      const Scene::Instance& instance = instances_[i].instance;
      const OwnJoints::Places places = joints.complete(writer, document_, instance, used_joints(i, all), changes_);
      weights_ = renumbered(all, places.of_joint);
      joint_count_ = places.count;
      attach(writer, scene, i, instance.node, instance.skin && rebound[*instance.skin]);
      document_.json["nodes"][instance.node]["skin"] = places.skin;
    }
    if (!source_.to_world.matrix().isIdentity(0.0)) {
      bring_to_world(document_, scene, source_.to_world);
      changes_.push_back("scaled and turned to metres and y up by a node above each root; joints and clips stay as they are");
    }
    Cleared nothing{{}, std::vector<bool>(document_.count("nodes")), std::vector<bool>(document_.count("skins")), {}, {}};
    remove_what_became_unused(nothing, before);
  }

  void run() {
    join_buffers(document_, changes_);
    const Usage before = usage();
    std::vector<std::string> told_at_load;
    const Scene scene = import_scene(document_, told_at_load).scene;
    Cleared cleared = clear_rig(document_, scene, instances_, changes_);
    const auto bind = shared_transform(instances_, options_.vertices);
    Writer writer(document_);
    for (std::size_t i = 0; i < instances_.size(); ++i) attach(writer, scene, i, cleared.mesh_nodes[i], !bind);
    const JointNodes joints = add_joints(writer, bind.value_or(Eigen::Affine3d::Identity()), cleared);
    hang_attachments(document_, scene, source_.to_world, cleared.attachments, joints, changes_);
    for (const std::size_t n : cleared.mesh_nodes)
      if (document_.json["nodes"][n].contains("mesh")) document_.json["nodes"][n]["skin"] = joints.skin;
    for (std::size_t s = 0; s < cleared.scenes_with_mesh.size(); ++s)
      if (cleared.scenes_with_mesh[s]) document_.json["scenes"][s]["nodes"].push_back(joints.root);
    remove_what_became_unused(cleared, before);
  }

 private:
  static constexpr Kind kKinds[] = {Kind::meshes, Kind::accessors, Kind::buffer_views};
  using Usage = std::array<std::vector<bool>, std::size(kKinds)>;

  Usage usage() const {
    Usage out;
    for (std::size_t k = 0; k < out.size(); ++k) out[k] = used_items(document_, kKinds[k]);
    return out;
  }

  // The skins that would show their meshes elsewhere than where they were read.
  std::vector<bool> skins_out_of_pose(const Scene& scene) const {
    std::vector<bool> out(scene.skins.size());
    for (const PlacedInstance& placed : instances_) {
      const bool placed_by_node = scene.meshes[placed.instance.mesh].influence_offsets.empty();
      if (placed.instance.skin && (placed_by_node || !placed.to_world)) out[*placed.instance.skin] = true;
    }
    return out;
  }

  JointNodes add_joints(Writer& writer, const Eigen::Affine3d& bind, const Cleared& cleared) {
    if (nodes_of_) return copy_joint_nodes(writer, document_, *nodes_of_, fit_, bind);
    return add_joint_nodes(writer, document_, skeleton_, bind, options_.names, node_names(cleared), changes_);
  }

  std::vector<bool> used_joints(std::size_t i, const SkinWeights& weights) const {
    std::vector<bool> used;
    for (const MeshLayout::Block& block : source_.layouts[instances_[i].instance.mesh].blocks)
      for (const VertexId v : vertices_of(instances_[i], block))
        for (const Influence& influence : weights[v]) {
          used.resize(std::max(used.size(), index(influence.joint) + 1), false);
          used[index(influence.joint)] = true;
        }
    return used;
  }

  VertexId asset_vertex(std::size_t document_vertex) const {
    return source_.asset_vertices.empty() ? static_cast<VertexId>(document_vertex) : source_.asset_vertices[document_vertex];
  }

  std::vector<VertexId> vertices_of(const PlacedInstance& placed, const MeshLayout::Block& block) const {
    std::vector<VertexId> vertices(block.count);
    for (std::size_t v = 0; v < block.count; ++v) vertices[v] = asset_vertex(placed.first_vertex + block.first + v);
    return vertices;
  }

  // Gives the mesh of one instance its weights, in a copy of the mesh if other nodes show it too.
  void attach(Writer& writer, const Scene& scene, std::size_t i, std::size_t node, bool bake) {
    const PlacedInstance& placed = instances_[i];
    const std::size_t m = placed.instance.mesh;
    const MeshLayout& layout = source_.layouts[m];
    Json mesh = original_mesh(m);
    Json primitives = Json::array();
    std::vector<Json> skin_attributes(layout.blocks.size());
    Baker baker(document_, writer, placed, scene.meshes[m]);
    const bool rewrite = bake && !(placed.to_world && placed.to_world->matrix().isIdentity(0.0));
    for (std::size_t p = 0; p < layout.primitives.size(); ++p) {
      const MeshLayout::Primitive& part = layout.primitives[p];
      if (!part.block || layout.blocks[*part.block].count == 0 || (part.faces_dropped && part.face_count == 0)) continue;
      const MeshLayout::Block& block = layout.blocks[*part.block];
      const std::vector<VertexId> vertices = vertices_of(placed, block);
      Json primitive = mesh.at("primitives").at(p);
      if (rewrite)
        baker.bake(primitive, block, positions_of(vertices));
      else if (block.repaired)
        baker.repair(primitive, block);
      const bool mirrored = placed.to_world && placed.to_world->linear().determinant() < 0.0;
      if (part.faces_dropped || (rewrite && mirrored && part.face_count > 0)) rewrite_faces(writer, primitive, placed, part, block);
      if (skin_attributes[*part.block].is_null())
        skin_attributes[*part.block] = add_skin_attributes(writer, vertices, weights_, joint_count_, options_);
      replace_skin(primitive.at("attributes"), skin_attributes[*part.block]);
      primitives.push_back(std::move(primitive));
    }
    put_mesh(std::move(mesh), std::move(primitives), m, node);
  }

  const Json& original_mesh(std::size_t m) {
    originals_.resize(source_.layouts.size());
    if (originals_[m].is_null()) originals_[m] = document_.json.at("meshes").at(m);
    return originals_[m];
  }

  std::vector<Vec3f> positions_of(const std::vector<VertexId>& vertices) const {
    std::vector<Vec3f> positions;
    positions.reserve(vertices.size());
    for (const VertexId v : vertices) positions.push_back(mesh_.positions[v]);
    return positions;
  }

  void rewrite_faces(Writer& writer, Json& primitive, const PlacedInstance& placed, const MeshLayout::Primitive& part,
                     const MeshLayout::Block& block) {
    std::vector<std::uint32_t> corners;
    for (std::size_t f = 0; f < part.face_count; ++f)
      for (const VertexId v : mesh_.faces[static_cast<FaceId>(placed.first_face + part.first_face + f)])
        corners.push_back(static_cast<std::uint32_t>(index(v) - placed.first_vertex - block.first));
    primitive["indices"] = writer.scalars(corners);
    primitive["mode"] = 4;
  }

  static void replace_skin(Json& attributes, const Json& skin) {
    Json kept = Json::object();
    for (const auto& [name, accessor] : attributes.items())
      if (!name.starts_with("JOINTS_") && !name.starts_with("WEIGHTS_")) kept[name] = accessor;
    for (const auto& [name, accessor] : skin.items()) kept[name] = accessor;
    attributes = std::move(kept);
  }

  void put_mesh(Json mesh, Json primitives, std::size_t m, std::size_t node) {
    Json& json = document_.json;
    if (primitives.empty()) {  // nothing of it can be seen
      json["nodes"][node].erase("mesh");
      return;
    }
    mesh["primitives"] = std::move(primitives);
    const bool shown_elsewhere = std::any_of(
        json["nodes"].begin(), json["nodes"].end(),
        [&, n = std::size_t{0}](const Json& other) mutable { return n++ != node && other.contains("mesh") && other["mesh"] == m; });
    if (shown_elsewhere) {
      json["meshes"].push_back(std::move(mesh));
      json["nodes"][node]["mesh"] = json["meshes"].size() - 1;
    } else {
      json["meshes"][m] = std::move(mesh);
    }
  }

  std::set<std::string> node_names(const Cleared& cleared) const {
    std::set<std::string> names;
    for (std::size_t n = 0; n < cleared.removed_nodes.size(); ++n)
      if (!cleared.removed_nodes[n]) names.insert(document_.at("nodes", n).text_or("name", ""));
    return names;
  }

  // Only what was used and no longer is: what nobody used in the file that came in is none of our business.
  void remove_what_became_unused(Cleared& cleared, const Usage& before) {
    cleared.removed_skins.resize(document_.count("skins"));
    remove_items(document_, Kind::skins, cleared.removed_skins);
    if (!references_are_known(document_)) return;
    cleared.removed_nodes.resize(document_.count("nodes"));
    remove_items(document_, Kind::nodes, cleared.removed_nodes);
    bool shrunk = false;
    for (std::size_t k = 0; k < std::size(kKinds); ++k) {
      std::vector<bool> unused = used_items(document_, kKinds[k]);
      unused.flip();
      for (std::size_t i = 0; i < before[k].size(); ++i) unused[i] = unused[i] && before[k][i];
      shrunk = kKinds[k] == Kind::buffer_views && std::find(unused.begin(), unused.end(), true) != unused.end();
      remove_items(document_, kKinds[k], unused);
    }
    if (shrunk) repack_buffer(document_);
  }

  GltfSource& source_;
  Document& document_;
  const std::vector<PlacedInstance>& instances_;
  const TriangleMesh& mesh_;
  const Skeleton skeleton_;
  SkinWeights weights_;  // joints numbered as in the skin that is written
  const SaveOptions& options_;
  std::vector<std::string>& changes_;
  std::vector<Json> originals_;
  std::size_t joint_count_;  // of that skin
  const SkeletonSource* nodes_of_ = nullptr;
  Eigen::Affine3d fit_ = Eigen::Affine3d::Identity();
};

}  // namespace

bool can_replace_weights(const SourceDocument& source) {
  std::vector<std::string> told_at_load;
  const Scene scene = import_scene(source.gltf->document, told_at_load).scene;
  const auto tree = joint_tree(scene, told_at_load);
  return can_bind(scene, nodes_of_joints(*tree, tree->skeleton.size())) &&
         std::ranges::all_of(source.instances, [](const PlacedInstance& placed) {
           return std::ranges::all_of(placed.joint_to_world, [](const Eigen::Affine3d& m) { return m.linear().fullPivLu().isInvertible(); });
         });
}

void replace_weights(GltfSource& source, const std::vector<PlacedInstance>& instances, const TriangleMesh& mesh, const SkinWeights& weights,
                     const SaveOptions& options, std::vector<std::string>& changes) {
  RigAttachment(source, instances, mesh, {}, weights, options, changes).run_with_own_joints();
}

void attach_rig(GltfSource& source, const std::vector<PlacedInstance>& instances, const TriangleMesh& mesh, const SkeletonFile& skeleton,
                const Eigen::Affine3d& fit, const SkinWeights& weights, const SaveOptions& options, std::vector<std::string>& changes) {
  RigAttachment attachment(source, instances, mesh, skeleton.skeleton, weights, options, changes);
  attachment.use_nodes_of(*skeleton.source, fit);
  attachment.run();
}

void attach_rig(GltfSource& source, const std::vector<PlacedInstance>& instances, const TriangleMesh& mesh, const Skeleton& skeleton,
                const SkinWeights& weights, const SaveOptions& options, std::vector<std::string>& changes) {
  RigAttachment(source, instances, mesh, skeleton, weights, options, changes).run();
}

}  // namespace osteon::io::gltf
