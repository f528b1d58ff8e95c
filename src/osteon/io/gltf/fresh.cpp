// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/gltf/fresh.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "osteon/base/error.h"
#include "osteon/io/gltf/single_buffer.h"
#include "osteon/io/gltf/writer.h"

namespace osteon::io::gltf {
namespace {

constexpr std::uint32_t kNone = UINT32_MAX;

// A vertex of the document: a vertex of the mesh as the corners see it that share its normal and texture coordinate.
struct Split {
  VertexId vertex;
  std::uint32_t normal, coordinate;
  std::uint32_t next;  // the next split of the same vertex
};

// The faces of one material as a primitive's arrays.
struct Part {
  std::vector<Split> splits;
  std::vector<std::uint32_t> corners;
};

class Splitter {
 public:
  Splitter(const TriangleMesh& mesh, const Appearance& appearance)
      : mesh_(mesh), appearance_(appearance), first_split_(mesh.positions.size(), kNone) {}

  Part split(const std::vector<FaceId>& faces) {
    Part part;
    for (const FaceId f : faces)
      for (std::size_t k = 0; k < 3; ++k) part.corners.push_back(split_of(part, f, k));
    for (const Split& s : part.splits) first_split_[index(s.vertex)] = kNone;
    sort_by_vertex(part);
    return part;
  }

 private:
  // The mesh's own order: a mesh without seams keeps its vertices' numbers.
  static void sort_by_vertex(Part& part) {
    std::vector<std::uint32_t> order(part.splits.size()), place(part.splits.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return part.splits[a].vertex < part.splits[b].vertex; });
    std::vector<Split> sorted;
    for (std::uint32_t k = 0; k < order.size(); ++k) {
      place[order[k]] = k;
      sorted.push_back(part.splits[order[k]]);
    }
    part.splits = std::move(sorted);
    for (std::uint32_t& corner : part.corners) corner = place[corner];
  }

  std::uint32_t split_of(Part& part, FaceId f, std::size_t k) {
    const auto corner = [&](const auto& layer) { return layer.values.empty() ? kNone : layer.corners[index(f)][k]; };
    const VertexId v = mesh_.faces[f][k];
    const std::uint32_t normal = corner(appearance_.normals), coordinate = corner(appearance_.texture_coordinates);
    std::uint32_t* link = &first_split_[index(v)];
    while (*link != kNone) {
      Split& s = part.splits[*link];
      if (s.normal == normal && s.coordinate == coordinate) return *link;
      link = &s.next;
    }
    *link = static_cast<std::uint32_t>(part.splits.size());
    part.splits.push_back({v, normal, coordinate, kNone});
    return static_cast<std::uint32_t>(part.splits.size() - 1);
  }

  const TriangleMesh& mesh_;
  const Appearance& appearance_;
  std::vector<std::uint32_t> first_split_;
};

// So many objects are no longer what an artist has named, and viewers would suffer from them.
constexpr std::size_t kMostObjects = 1000;

// By object and material.
using FaceGroups = std::map<std::uint32_t, std::map<std::uint32_t, std::vector<FaceId>>>;

bool are_kept(const std::vector<std::string>& objects) { return !objects.empty() && objects.size() <= kMostObjects; }

// Without the faces that name a vertex twice.
FaceGroups face_groups(const TriangleMesh& mesh, const Appearance& appearance) {
  FaceGroups out;
  for (const FaceId f : mesh.faces.ids()) {
    const auto [a, b, c] = mesh.faces[f];
    if (a == b || b == c || c == a) continue;
    const auto of = [&](const std::vector<std::uint32_t>& numbers) { return numbers.empty() ? 0 : numbers[index(f)]; };
    out[are_kept(appearance.objects) ? of(appearance.face_objects) : 0][of(appearance.face_materials)].push_back(f);
  }
  return out;
}

std::size_t add_texture(Document& document, const Scene::Texture& texture) {
  const std::filesystem::path& file = texture.file;
  const Bytes bytes = texture.image.empty() ? read_file(file) : texture.image;
  const std::string type = image_type(bytes);
  if (type != "image/png" && type != "image/jpeg") throw Error("{}: neither PNG nor JPEG", file.filename().string());
  const std::size_t view = Writer(document).image(bytes);
  Json& json = document.json;
  json["images"].push_back(Json{{"name", file.stem().string()}, {"bufferView", view}, {"mimeType", type}});
  json["textures"].push_back(Json{{"source", json["images"].size() - 1}});
  return json["textures"].size() - 1;
}

std::size_t coordinate_sets(const Appearance& appearance) {
  return appearance.texture_coordinates.values.empty() ? 0 : 1 + appearance.coordinates_after.size();
}

// What a material says of a texture; nothing where there is none, or nothing to lay it out by.
std::optional<Json> texture_info(Document& document, const Scene::Texture& texture, const std::string& material, std::size_t sets,
                                 std::vector<std::string>& changes) {
  if (!texture.is_there() || texture.coordinate_set >= sets) return std::nullopt;
  try {
    Json info{{"index", add_texture(document, texture)}};
    if (texture.coordinate_set > 0) info["texCoord"] = texture.coordinate_set;
    return info;
  } catch (const Error& e) {
    changes.push_back(fmt::format("{}; the material '{}' goes without this texture", e.what(), material));
    return std::nullopt;
  }
}

std::size_t add_material(Document& document, const Scene::Material& material, std::size_t sets, std::vector<std::string>& changes) {
  const Eigen::Vector4f& c = material.colour;
  Json surface{
      {"baseColorFactor", {c.x(), c.y(), c.z(), c.w()}}, {"metallicFactor", material.metallic}, {"roughnessFactor", material.roughness}};
  if (auto base = texture_info(document, material.base, material.name, sets, changes)) surface["baseColorTexture"] = *base;
  Json json{{"name", material.name}, {"pbrMetallicRoughness", surface}, {"doubleSided", true}};
  if (auto normals = texture_info(document, material.normals, material.name, sets, changes)) json["normalTexture"] = *normals;
  if (c.w() < 1.0f) json["alphaMode"] = "BLEND";
  document.json["materials"].push_back(std::move(json));
  return document.json["materials"].size() - 1;
}

Json attributes_of(Writer& writer, const Part& part, const TriangleMesh& mesh, const PerVertex<Vec3f>& smooth,
                   const Appearance& appearance) {
  std::vector<Vec3f> positions, normals;
  std::vector<float> coordinates;
  std::vector<std::uint32_t> colours;
  for (const Split& s : part.splits) {
    positions.push_back(mesh.positions[s.vertex]);
    const Vec3f normal = s.normal == kNone ? Vec3f(Vec3f::Zero()) : appearance.normals.values[s.normal];
    normals.push_back(normal.isZero(0.0f) ? smooth[s.vertex] : normal);
    if (s.coordinate != kNone)
      for (const float u : appearance.texture_coordinates.values[s.coordinate]) coordinates.push_back(u);
    if (!appearance.colours.empty())
      for (const float c : appearance.colours[index(s.vertex)])
        colours.push_back(static_cast<std::uint32_t>(std::clamp(c, 0.0f, 1.0f) * 65535.0f + 0.5f));
  }
  Json attributes{{"POSITION", writer.positions(positions)},
                  {"NORMAL", writer.vectors({normals[0].data(), 3 * normals.size()}, 3, Target::vertices)}};
  if (!coordinates.empty()) attributes["TEXCOORD_0"] = writer.vectors(coordinates, 2, Target::vertices);
  for (std::size_t set = 1; set < coordinate_sets(appearance); ++set) {
    coordinates.clear();
    for (const Split& s : part.splits)
      for (const float u : appearance.coordinates_after[set - 1][s.vertex]) coordinates.push_back(u);
    attributes[fmt::format("TEXCOORD_{}", set)] = writer.vectors(coordinates, 2, Target::vertices);
  }
  if (!colours.empty()) attributes["COLOR_0"] = writer.vec4(colours, 2, true);
  return attributes;
}

class DocumentMaker {
 public:
  DocumentMaker(const TriangleMesh& mesh, const Appearance& appearance, std::vector<std::string>& changes)
      : mesh_(mesh),
        appearance_(appearance),
        changes_(changes),
        smooth_(vertex_normals(mesh)),
        splitter_(mesh, appearance),
        offsets_(mesh.positions.size(), Vec3f(Vec3f::Zero())) {
    document_.json = Json{{"asset", {{"version", "2.0"}, {"generator", "Osteon"}}},
                          {"scene", 0},
                          {"scenes", Json::array({Json{{"nodes", Json::array()}}})},
                          {"nodes", Json::array()},
                          {"meshes", Json::array()}};
  }

  Fresh run(const std::string& name) {
    const std::vector<std::string>& objects = appearance_.objects;
    if (objects.size() > kMostObjects)
      changes_.push_back(fmt::format("{} objects, more than {}; made one of them", objects.size(), kMostObjects));
    const FaceGroups groups = face_groups(mesh_, appearance_);
    if (groups.empty()) throw Error("no face has three different vertices");
    for (const auto& [object, by_material] : groups)
      add_object(are_kept(objects) && !objects[object].empty() ? objects[object] : name, by_material);
    return std::move(out_);
  }

 private:
  void add_object(const std::string& name, const std::map<std::uint32_t, std::vector<FaceId>>& by_material) {
    const std::size_t first = out_.source.asset_vertices.size(), m = document_.json["meshes"].size();
    Writer writer(document_);
    MeshLayout layout;
    std::vector<Part> parts;
    Json primitives = Json::array();
    for (const auto& [material, faces] : by_material) {
      parts.push_back(splitter_.split(faces));
      const Part& part = parts.back();
      Json primitive{{"attributes", attributes_of(writer, part, mesh_, smooth_, appearance_)}, {"indices", writer.scalars(part.corners)}};
      primitive["material"] = material_number(material);
      layout.blocks.push_back(
          {primitive["attributes"]["POSITION"].get<std::size_t>(), out_.source.asset_vertices.size() - first, part.splits.size(), false});
      layout.primitives.push_back({layout.blocks.size() - 1});
      for (const Split& s : part.splits) out_.source.asset_vertices.push_back(s.vertex);
      primitives.push_back(std::move(primitive));
    }
    Json mesh{{"name", name}};
    add_morphs(writer, parts, primitives, mesh);
    mesh["primitives"] = std::move(primitives);
    document_.json["meshes"].push_back(std::move(mesh));
    document_.json["nodes"].push_back(Json{{"name", name}, {"mesh", m}});
    document_.json["scenes"][0]["nodes"].push_back(m);
    out_.source.layouts.push_back(std::move(layout));
    out_.instances.push_back({Scene::Instance{m, m, std::nullopt}, first, 0, Eigen::Affine3d::Identity(), {}});
  }

  // Those that move a vertex of the object; all its primitives get them, as glTF asks for.
  void add_morphs(Writer& writer, const std::vector<Part>& parts, Json& primitives, Json& mesh) {
    for (const Appearance::Morph& morph : appearance_.morphs) {
      for (std::size_t i = 0; i < morph.vertices.size(); ++i) offsets_[morph.vertices[i]] = morph.offsets[i];
      const auto is_moved = [&](const Split& s) { return !offsets_[s.vertex].isZero(0.0f); };
      if (std::ranges::any_of(parts, [&](const Part& part) { return std::ranges::any_of(part.splits, is_moved); })) {
        for (std::size_t p = 0; p < parts.size(); ++p) {
          std::vector<Vec3f> offsets;
          for (const Split& s : parts[p].splits) offsets.push_back(offsets_[s.vertex]);
          primitives[p]["targets"].push_back(Json{{"POSITION", writer.positions(offsets)}});
        }
        mesh["weights"].push_back(0.0);
        mesh["extras"]["targetNames"].push_back(morph.name);
      }
      for (const VertexId v : morph.vertices) offsets_[v].setZero();
    }
  }

  std::size_t material_number(std::uint32_t material) {
    const auto [entry, is_new] = material_numbers_.emplace(material, 0);
    if (is_new)
      entry->second = add_material(document_, appearance_.materials.empty() ? Scene::Material::plain() : appearance_.materials[material],
                                   coordinate_sets(appearance_), changes_);
    return entry->second;
  }

  const TriangleMesh& mesh_;
  const Appearance& appearance_;
  std::vector<std::string>& changes_;
  const PerVertex<Vec3f> smooth_;
  Splitter splitter_;
  PerVertex<Vec3f> offsets_;  // of the morph at hand
  std::map<std::uint32_t, std::size_t> material_numbers_;
  Fresh out_;
  Document& document_ = out_.source.document;
};

}  // namespace

Fresh fresh_document(const std::string& name, const TriangleMesh& mesh, const Appearance& appearance, std::vector<std::string>& changes) {
  return DocumentMaker(mesh, appearance, changes).run(name);
}

}  // namespace osteon::io::gltf
