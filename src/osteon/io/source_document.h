// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>

#include "osteon/io/gltf/document.h"
#include "osteon/io/scene.h"

namespace osteon::io {

// Which vertices of a glTF mesh became which of the Scene's: one block for each POSITION accessor, as primitives may share one.
struct MeshLayout {
  struct Block {
    std::size_t accessor;  // POSITION
    std::size_t first;     // its first vertex in Scene::Mesh
    std::size_t count;
    bool repaired;  // some of its positions were not finite
  };
  struct Primitive {
    std::optional<std::size_t> block;            // empty: it has no vertices, or was skipped
    std::optional<std::vector<Triangle>> faces;  // set when faces had to be dropped: what is left, relative to the block
  };
  std::vector<Block> blocks;
  std::vector<Primitive> primitives;  // as many as the mesh has
};

struct GltfSource {
  gltf::Document document;
  std::vector<MeshLayout> layouts;  // one for each glTF mesh
};

// Where a mesh of the scene went in Asset::mesh, and how its vertices came to world space.
struct PlacedInstance {
  Scene::Instance instance;
  std::size_t first_vertex;
  // mesh space -> world, if one transform does it for all vertices; empty when a skin that does not stand in its bind pose deforms the mesh
  std::optional<Eigen::Affine3d> to_world;
};

struct SourceDocument {
  std::optional<GltfSource> gltf;
  std::vector<PlacedInstance> instances;
};

}  // namespace osteon::io
