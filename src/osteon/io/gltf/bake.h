// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <map>
#include <span>

#include "osteon/io/gltf/writer.h"
#include "osteon/io/source_document.h"

namespace osteon::io::gltf {

// Rewrites the vertices of one placed mesh in world space: POSITION, NORMAL, TANGENT and the same of its morph targets.
// Each of the document's accessors is rewritten once, however many primitives share it.
class Baker {
 public:
  // `mesh` is what import_scene() read for the instance; it outlives the Baker, as the others do.
  Baker(const Document& document, Writer& writer, const PlacedInstance& placed, const Scene::Mesh& mesh);

  // `primitive` is the JSON to change; `positions` are those of its block, world space.
  void bake(Json& primitive, const MeshLayout::Block& block, std::span<const Vec3f> positions);

  // Rewrites nothing but POSITION, in the mesh's own space, as it was repaired.
  void repair(Json& primitive, const MeshLayout::Block& block);

 private:
  using Rewrite = std::function<std::size_t()>;
  void replace(Json& attributes, const char* name, const std::string& rule, const Rewrite& rewrite);
  std::vector<float> read(const Json& accessor, std::size_t components, std::size_t count) const;
  Eigen::Affine3d transform(std::size_t vertex) const;
  std::size_t bake_normals(const Json& accessor, const MeshLayout::Block& block);
  std::size_t bake_tangents(const Json& accessor, const MeshLayout::Block& block);
  std::size_t bake_directions(const Json& accessor, const MeshLayout::Block& block, bool bounds);
  std::size_t bake_normal_changes(const Json& change, const Json& normals, const MeshLayout::Block& block);

  const Document& document_;
  Writer& writer_;
  const PlacedInstance& placed_;
  const Scene::Mesh& mesh_;
  std::map<std::pair<std::size_t, std::string>, std::size_t> done_;  // (old accessor, rule) -> new accessor
};

}  // namespace osteon::io::gltf
