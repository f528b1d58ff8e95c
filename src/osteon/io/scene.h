// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "osteon/io/load.h"

namespace osteon::io {

// What an importer hands over: tolerant (any unit, axes, number of roots, weights that do not sum to one), but with every index in range
// and the node tree free of cycles. assemble() makes the strict Asset of it.
struct Scene {
  struct Node {
    std::string name;  // may be empty or not unique
    std::optional<std::size_t> parent;
    Eigen::Affine3d world = Eigen::Affine3d::Identity();  // node -> file's world, not yet scaled to metres or turned y up
  };
  struct Influence {
    std::uint32_t joint;  // index into Skin::joints
    float weight;
  };
  struct Texture {
    std::filesystem::path file;        // may not exist; empty if there is none
    std::vector<std::uint8_t> image;   // the picture itself where the file holds it
    std::uint32_t coordinate_set = 0;  // the texture coordinates that it is laid out by

    bool is_there() const { return !file.empty() || !image.empty(); }
  };
  struct Material {
    std::string name;
    Eigen::Vector4f colour = Eigen::Vector4f::Ones();  // linear, with opacity
    float metallic = 0.0f, roughness = 1.0f;           // as colours are meant in formats that do not speak of it
    Texture base, normals;                             // colours; normals in tangent space

    static Material plain(std::string name = "surface");  // for faces without a material
  };
  // Values at the corners of faces, several of which may share one. Empty if the file has none.
  template <class T>
  struct Layer {
    std::vector<T> values;
    std::vector<std::array<std::uint32_t, 3>> corners;  // for each face, indices into values
  };
  // A shape that the mesh can take beside its own.
  struct Morph {
    std::string name;
    std::vector<Vec3f> offsets;  // one for each position
  };
  struct Mesh {
    std::vector<Vec3f> positions;
    std::vector<Triangle> faces;
    Layer<Vec3f> normals;
    Layer<Eigen::Vector2f> texture_coordinates;                   // origin at the top left, as in glTF
    std::vector<std::vector<Eigen::Vector2f>> coordinates_after;  // further sets of them, each with one for each position
    std::vector<Eigen::Vector4f> colours;                         // linear; one for each position, or none
    std::vector<Morph> morphs;
    std::vector<std::uint32_t> face_materials;     // one for each face, or none
    std::vector<std::string> objects;              // names of the objects that it consists of; none: what the node is called
    std::vector<std::uint32_t> face_objects;       // one for each face, or none
    std::vector<std::uint32_t> influence_offsets;  // size positions + 1, or empty when nothing is skinned
    std::vector<Influence> influences;
  };
  struct Skin {
    std::vector<std::size_t> joints;  // nodes
    std::vector<Eigen::Affine3d> inverse_binds;
  };
  struct Instance {  // a mesh placed in the scene
    std::size_t node;
    std::size_t mesh;
    std::optional<std::size_t> skin;  // then the node's transform does not apply to the mesh
  };

  std::vector<Node> nodes;
  std::vector<Material> materials;
  std::vector<Mesh> meshes;
  std::vector<Skin> skins;
  std::vector<Instance> instances;
  UpAxis up = UpAxis::y;  // what the file says, overruled by LoadOptions
  double metres_per_unit = 1.0;
};

// Larger coordinates than this are taken for garbage like NaN is: their squares overflow a float.
constexpr float kLargestCoordinate = 1e15f;

// Moves vertices with such coordinates to the origin. Returns how many there were.
std::size_t repair_positions(std::span<Vec3f> positions);

}  // namespace osteon::io
