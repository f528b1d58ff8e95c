// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/appearance.h"

#include <algorithm>

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
      if (has_colours_) {
        out_.colours.insert(out_.colours.end(), mesh.colours.begin(), mesh.colours.end());
        out_.colours.resize(out_.colours.size() + mesh.positions.size() - mesh.colours.size(), Eigen::Vector4f::Ones());
      }
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

  // A skin that deforms the mesh turns normals vertex by vertex; only there they must be the vertices' own.
  Vec3f normal(const PlacedInstance& placed, const Scene::Mesh& mesh, std::size_t i) const {
    const bool per_vertex = mesh.normals.values.size() == mesh.positions.size();
    if (!placed.to_world && !per_vertex) return Vec3f::Zero();
    const Eigen::Affine3d m = placed.to_world ? *placed.to_world : blended_transform(mesh, i, placed.joint_to_world);
    const Eigen::Vector3d n = normal_matrix(m) * mesh.normals.values[i].cast<double>();
    const double length = n.norm();
    return std::isfinite(length) && length > 0.0 ? Vec3f((n / length).cast<float>()) : Vec3f(Vec3f::Zero());
  }

  void append_materials(const Scene::Mesh& mesh) {
    out_.face_materials.insert(out_.face_materials.end(), mesh.face_materials.begin(), mesh.face_materials.end());
    if (mesh.face_materials.size() == mesh.faces.size()) return;
    if (!plain_material_) {
      plain_material_ = static_cast<std::uint32_t>(out_.materials.size());
      out_.materials.push_back({"surface", {0.8f, 0.8f, 0.8f, 1.0f}, {}, {}});
    }
    out_.face_materials.resize(out_.face_materials.size() + mesh.faces.size() - mesh.face_materials.size(), *plain_material_);
  }

  const Scene& scene_;
  const std::vector<PlacedInstance>& instances_;
  bool has_normals_ = false, has_coordinates_ = false, has_colours_ = false, has_materials_ = false;
  std::optional<std::uint32_t> plain_material_;
  Appearance out_;
};

}  // namespace

Appearance merged_appearance(const Scene& scene, const std::vector<PlacedInstance>& instances) { return Merger(scene, instances).run(); }

}  // namespace osteon::io
