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
    std::optional<std::size_t> block;            // empty: it has no positions and was left out
    std::size_t first_face = 0, face_count = 0;  // in Scene::Mesh::faces
    bool faces_dropped = false;                  // some of its faces had indices out of range
  };
  std::vector<Block> blocks;
  std::vector<Primitive> primitives;  // as many as the mesh has
};

struct GltfSource {
  gltf::Document document;
  std::vector<MeshLayout> layouts;  // one for each glTF mesh
  // The vertex of Asset::mesh that each vertex of the document's instances is, one instance after the other. Empty: the same numbers.
  std::vector<VertexId> asset_vertices;
  Eigen::Affine3d to_world = Eigen::Affine3d::Identity();  // of the file -> ours
};

// What else is known of an Asset::mesh that did not come from glTF; its layers are empty where the file had nothing.
struct Appearance {
  struct Morph {
    std::string name;
    std::vector<VertexId> vertices;  // those that it moves
    std::vector<Vec3f> offsets;      // by how much, world space
  };
  std::vector<Scene::Material> materials;
  std::vector<std::uint32_t> face_materials;  // one for each face
  Scene::Layer<Vec3f> normals;                // world space, of unit length, or zero where the file has none
  Scene::Layer<Eigen::Vector2f> texture_coordinates;
  std::vector<PerVertex<Eigen::Vector2f>> coordinates_after;  // further sets of texture coordinates
  std::vector<Eigen::Vector4f> colours;                       // one for each vertex
  std::vector<Morph> morphs;                                  // of different names
  std::vector<std::string> objects;                           // names; may be empty or not unique
  std::vector<std::uint32_t> face_objects;                    // one for each face
};

// Where a mesh of the scene went in Asset::mesh, and how its vertices came to world space.
struct PlacedInstance {
  Scene::Instance instance;
  std::size_t first_vertex, first_face;
  // mesh space -> world, if one transform does it for all vertices; empty when a skin that does not stand in its bind pose deforms the mesh
  std::optional<Eigen::Affine3d> to_world;
  std::vector<Eigen::Affine3d> joint_to_world;  // in that case: mesh space -> world for a vertex of each joint of the skin alone
};

struct SourceDocument {
  std::optional<GltfSource> gltf;  // exactly one of the two is there
  std::optional<Appearance> appearance;
  std::vector<PlacedInstance> instances;
};

// The glTF that a skeleton came from.
struct SkeletonSource {
  gltf::Document document;
  std::vector<std::optional<std::size_t>> node_of_joint;   // by JointId; empty for a root that the file did not have
  Eigen::Affine3d to_world = Eigen::Affine3d::Identity();  // of the file -> ours
};

}  // namespace osteon::io
