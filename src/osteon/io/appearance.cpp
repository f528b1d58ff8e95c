// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/appearance.h"

#include <algorithm>
#include <map>

#include "osteon/io/assemble.h"

namespace osteon::io {
namespace {

class Merger {
 public:
  Merger(const Scene& scene, const std::vector<PlacedInstance>& instances) : scene_(scene), instances_(instances) {
    out_.materials = scene.materials;
    for (const PlacedInstance& placed : instances) {
      const Scene::Mesh& mesh = mesh_of(placed);
      has_normals_ |= !mesh.normals.values.empty();
      has_coordinates_ |= !mesh.texture_coordinates.values.empty();
      has_colours_ |= !mesh.colours.empty();
      has_materials_ |= !mesh.face_materials.empty();
      out_.coordinates_after.resize(std::max(out_.coordinates_after.size(), mesh.coordinates_after.size()));
    }
  }

  Appearance run() {
    for (const PlacedInstance& placed : instances_) {
      const Scene::Mesh& mesh = mesh_of(placed);
      const bool mirrored = placed.to_world && placed.to_world->linear().determinant() < 0.0;
      if (has_normals_)
        append(out_.normals, mesh.normals, mesh.faces.size(), mirrored, [&](std::size_t i) { return normal(placed, mesh, i); });
      if (has_coordinates_)
        append(out_.texture_coordinates, mesh.texture_coordinates, mesh.faces.size(), mirrored,
               [&](std::size_t i) { return mesh.texture_coordinates.values[i]; });
      for (std::size_t set = 0; set < out_.coordinates_after.size(); ++set) {
        const auto& sets = mesh.coordinates_after;
        append_for_vertices(out_.coordinates_after[set].raw(), set < sets.size() ? sets[set] : std::vector<Eigen::Vector2f>(), mesh,
                            Eigen::Vector2f(0.0f, 0.0f));
      }
      if (has_colours_) append_for_vertices(out_.colours, mesh.colours, mesh, Eigen::Vector4f(Eigen::Vector4f::Ones()));
      append_objects(placed, mesh);
      append_morphs(placed, mesh);
      if (has_materials_) append_materials(mesh);
    }
    return std::move(out_);
  }

 private:
  const Scene::Mesh& mesh_of(const PlacedInstance& placed) const { return scene_.meshes[placed.instance.mesh]; }

  // Values of a mesh without the layer are one zero for all corners.
  template <class T, class Value>
  static void append(Scene::Layer<T>& out, const Scene::Layer<T>& layer, std::size_t faces, bool mirrored, Value value) {
    const auto first = static_cast<std::uint32_t>(out.values.size());
    if (layer.values.empty()) {
      out.values.push_back(T(T::Zero()));
      out.corners.resize(out.corners.size() + faces, {first, first, first});
      return;
    }
    for (std::size_t i = 0; i < layer.values.size(); ++i) out.values.push_back(value(i));
    for (const auto& c : layer.corners) out.corners.push_back({first + c[0], first + c[mirrored ? 2 : 1], first + c[mirrored ? 1 : 2]});
  }

  // Vertices of a mesh without such values get `otherwise`.
  template <class T>
  static void append_for_vertices(std::vector<T>& out, const std::vector<T>& values, const Scene::Mesh& mesh, const T& otherwise) {
    out.insert(out.end(), values.begin(), values.end());
    out.resize(out.size() + mesh.positions.size() - values.size(), otherwise);
  }

  // A mesh is the object that its node is, unless it tells of several; a node may show many.
  void append_objects(const PlacedInstance& placed, const Scene::Mesh& mesh) {
    if (mesh.objects.empty()) {
      const auto [object, is_new] = object_of_node_.emplace(placed.instance.node, static_cast<std::uint32_t>(out_.objects.size()));
      if (is_new) out_.objects.push_back(scene_.nodes[placed.instance.node].name);
      out_.face_objects.resize(out_.face_objects.size() + mesh.faces.size(), object->second);
      return;
    }
    const auto first = static_cast<std::uint32_t>(out_.objects.size());
    for (const std::uint32_t object : mesh.face_objects) out_.face_objects.push_back(first + object);
    out_.objects.insert(out_.objects.end(), mesh.objects.begin(), mesh.objects.end());
  }

  // Shapes of one name are one, whatever meshes take part in it.
  void append_morphs(const PlacedInstance& placed, const Scene::Mesh& mesh) {
    for (const Scene::Morph& morph : mesh.morphs) {
      const auto [number, is_new] = morph_of_name_.emplace(morph.name, out_.morphs.size());
      if (is_new) out_.morphs.push_back({morph.name, {}, {}});
      Appearance::Morph& out = out_.morphs[number->second];
      for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
        if (morph.offsets[v].isZero(0.0f)) continue;
        const Vec3f offset = (to_world(placed, mesh, v).linear() * morph.offsets[v].cast<double>()).cast<float>();
        if (!offset.allFinite()) continue;
        out.vertices.push_back(static_cast<VertexId>(placed.first_vertex + v));
        out.offsets.push_back(offset);
      }
    }
  }

  static Eigen::Affine3d to_world(const PlacedInstance& placed, const Scene::Mesh& mesh, std::size_t vertex) {
    return placed.to_world ? *placed.to_world : blended_transform(mesh, vertex, placed.joint_to_world);
  }

  // A skin that deforms the mesh turns normals vertex by vertex; only there they must be the vertices' own.
  Vec3f normal(const PlacedInstance& placed, const Scene::Mesh& mesh, std::size_t i) const {
    const bool per_vertex = mesh.normals.values.size() == mesh.positions.size();
    if (!placed.to_world && !per_vertex) return Vec3f::Zero();
    const Eigen::Vector3d n = normal_matrix(to_world(placed, mesh, i)) * mesh.normals.values[i].cast<double>();
    const double length = n.norm();
    return std::isfinite(length) && length > 0.0 ? Vec3f((n / length).cast<float>()) : Vec3f(Vec3f::Zero());
  }

  void append_materials(const Scene::Mesh& mesh) {
    out_.face_materials.insert(out_.face_materials.end(), mesh.face_materials.begin(), mesh.face_materials.end());
    if (mesh.face_materials.size() == mesh.faces.size()) return;
    if (!plain_material_) {
      plain_material_ = static_cast<std::uint32_t>(out_.materials.size());
      out_.materials.push_back(Scene::Material::plain());
    }
    out_.face_materials.resize(out_.face_materials.size() + mesh.faces.size() - mesh.face_materials.size(), *plain_material_);
  }

  const Scene& scene_;
  const std::vector<PlacedInstance>& instances_;
  bool has_normals_ = false, has_coordinates_ = false, has_colours_ = false, has_materials_ = false;
  std::optional<std::uint32_t> plain_material_;
  std::map<std::size_t, std::uint32_t> object_of_node_;
  std::map<std::string, std::size_t> morph_of_name_;
  Appearance out_;
};

}  // namespace

Appearance merged_appearance(const Scene& scene, const std::vector<PlacedInstance>& instances) { return Merger(scene, instances).run(); }

}  // namespace osteon::io
