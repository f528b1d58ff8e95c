// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <fstream>
#include <string>

#include "osteon/io/gltf/writer.h"
#include "support/expect.h"

namespace osteon::io::test {

using osteon::test::error_of;
using osteon::test::TemporaryFolder;

inline std::filesystem::path write(const std::filesystem::path& path, const std::string& content) {
  std::ofstream(path, std::ios::binary) << content;
  return path;
}

inline std::string read(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

// A tetrahedron of four vertices and faces, 1 m on each axis.
inline const std::vector<Vec3f> kCorners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
inline const std::vector<std::uint32_t> kFaces{0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3};

// A glTF document with the tetrahedron on node 0, no skin, with a textured material, extras and extensions of others.
inline gltf::Document tetrahedron_document() {
  gltf::Document document;
  document.json = gltf::Json::parse(R"({
    "asset": {"version": "2.0", "generator": "someone else", "extras": {"made": 2024.0}},
    "extensionsUsed": ["KHR_materials_emissive_strength"],
    "scene": 0,
    "scenes": [{"name": "stage", "nodes": [0]}],
    "nodes": [{"name": "body", "mesh": 0, "extras": {"hidden": false}}],
    "materials": [{"name": "skin", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "roughnessFactor": 0.25},
                   "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 2.0}}, "extras": {"note": "\u00fc"}}],
    "textures": [{"source": 0, "sampler": 0}], "samplers": [{"magFilter": 9729}], "images": [{"mimeType": "image/png", "bufferView": 0}],
    "meshes": [{"name": "tetra", "primitives": [{"attributes": {}, "material": 0, "extras": {"part": 1}}], "extras": {"tags": ["a", "b"]}}]})");
  gltf::Writer writer(document);
  const std::string picture = "\x89PNG\r\n\x1a\n not really";
  writer.image({reinterpret_cast<const std::uint8_t*>(picture.data()), picture.size()});
  const std::size_t position = writer.positions(kCorners);
  const std::vector<float> normals{0, 0, -1, 1, 0, 0, 0, 1, 0, 0, 0, 1}, coordinates{0, 0, 1, 0, 0, 1, 1, 1};
  const std::size_t normal = writer.vectors(normals, 3, gltf::Target::vertices),
                    coordinate = writer.vectors(coordinates, 2, gltf::Target::vertices);
  const std::size_t indices = writer.scalars(kFaces);
  gltf::Json& primitive = document.json["meshes"][0]["primitives"][0];
  primitive["attributes"] = {{"POSITION", position}, {"NORMAL", normal}, {"TEXCOORD_0", coordinate}};
  primitive["indices"] = indices;
  return document;
}

inline std::filesystem::path write_document(const std::filesystem::path& path, const gltf::Document& document) {
  gltf::write_glb(path, document);
  return path;
}

inline gltf::Document read_document(const std::filesystem::path& path) {
  std::vector<std::string> repairs;
  return gltf::parse(path, read_file(path), repairs);
}

// Adds two joints, one metre apart along x, to the tetrahedron: vertex 1 follows the second. Nodes 1 and 2.
inline gltf::Document skinned_tetrahedron_document() {
  gltf::Document document = tetrahedron_document();
  document.json["nodes"].push_back({{"name", "hip"}, {"translation", {0.5, 0, 0}}, {"children", {2}}});
  document.json["nodes"].push_back({{"name", "knee"}, {"translation", {1, 0, 0}}});
  document.json["scenes"][0]["nodes"] = {0, 1};
  gltf::Writer writer(document);
  const std::vector<std::uint32_t> joints{0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0};
  const std::vector<float> weights{1, 0, 0, 0, 1, 0, 0, 0, 0.75, 0.25, 0, 0, 1, 0, 0, 0};
  std::vector<float> inverse_binds(32);
  for (const int m : {0, 16})
    for (const int d : {0, 5, 10, 15}) inverse_binds[static_cast<std::size_t>(m + d)] = 1;
  inverse_binds[12] = -0.5f;
  inverse_binds[16 + 12] = -1.5f;
  gltf::Json& attributes = document.json["meshes"][0]["primitives"][0]["attributes"];
  attributes["JOINTS_0"] = writer.vec4(joints, 1, false);
  attributes["WEIGHTS_0"] = writer.vectors(weights, 4, gltf::Target::vertices);
  const std::size_t matrices = writer.vectors(inverse_binds, 16, gltf::Target::none);
  document.json["skins"] = gltf::Json::array({gltf::Json{{"joints", {1, 2}}, {"inverseBindMatrices", matrices}}});
  document.json["nodes"][0]["skin"] = 0;
  return document;
}

// The one repair that contains `text`, or what was found instead.
inline testing::AssertionResult has_repair(const std::vector<std::string>& repairs, const std::string& text) {
  for (const std::string& r : repairs)
    if (r.find(text) != std::string::npos) return testing::AssertionSuccess();
  auto result = testing::AssertionFailure() << "no repair says '" << text << "' among " << repairs.size() << ":";
  for (const std::string& r : repairs) result << "\n  " << r;
  return result;
}

}  // namespace osteon::io::test
