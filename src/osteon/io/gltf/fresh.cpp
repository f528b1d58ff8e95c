// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/gltf/fresh.h"

#include <algorithm>
#include <cassert>
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

// Faces by material; those that name a vertex twice left out, unless nothing else is there.
std::vector<std::vector<FaceId>> faces_by_material(const TriangleMesh& mesh, const Appearance& appearance) {
  std::vector<std::vector<FaceId>> out(std::max<std::size_t>(appearance.materials.size(), 1));
  for (const FaceId f : mesh.faces.ids()) {
    const auto [a, b, c] = mesh.faces[f];
    if (a == b || b == c || c == a) continue;
    out[appearance.face_materials.empty() ? 0 : appearance.face_materials[index(f)]].push_back(f);
  }
  return out;
}

std::size_t add_texture(Document& document, const Scene::Material& material) {
  const std::filesystem::path& file = material.texture;
  const Bytes bytes = material.image.empty() ? read_file(file) : material.image;
  const std::string type = image_type(bytes);
  if (type != "image/png" && type != "image/jpeg") throw Error("{}: neither PNG nor JPEG", file.filename().string());
  const std::size_t view = Writer(document).image(bytes);
  Json& json = document.json;
  json["images"].push_back(Json{{"name", file.stem().string()}, {"bufferView", view}, {"mimeType", type}});
  json["textures"].push_back(Json{{"source", json["images"].size() - 1}});
  return json["textures"].size() - 1;
}

// Not metallic, as the colours of other formats mean; glTF's default would be.
std::size_t add_material(Document& document, const Scene::Material& material, bool textured, std::vector<std::string>& changes) {
  const Eigen::Vector4f& c = material.colour;
  Json surface{{"baseColorFactor", {c.x(), c.y(), c.z(), c.w()}}};
  if (textured && !(material.texture.empty() && material.image.empty())) {
    try {
      surface["baseColorTexture"] = Json{{"index", add_texture(document, material)}};
    } catch (const Error& e) {
      changes.push_back(fmt::format("{}; the material '{}' goes without this texture", e.what(), material.name));
    }
  }
  surface["metallicFactor"] = 0.0;
  Json json{{"name", material.name}, {"pbrMetallicRoughness", surface}, {"doubleSided", true}};
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
  if (!colours.empty()) attributes["COLOR_0"] = writer.vec4(colours, 2, true);
  return attributes;
}

}  // namespace

GltfSource fresh_document(const std::string& name, const TriangleMesh& mesh, const Appearance& appearance,
                          std::vector<std::string>& changes) {
  GltfSource source;
  Document& document = source.document;
  document.json = Json{{"asset", {{"version", "2.0"}, {"generator", "Osteon"}}},
                       {"scene", 0},
                       {"scenes", Json::array({Json{{"nodes", {0}}}})},
                       {"nodes", Json::array({Json{{"name", name}, {"mesh", 0}}})},
                       {"meshes", Json::array({Json{{"name", name}, {"primitives", Json::array()}}})}};
  const auto groups = faces_by_material(mesh, appearance);
  const PerVertex<Vec3f> smooth = vertex_normals(mesh);
  Splitter splitter(mesh, appearance);
  Writer writer(document);
  MeshLayout layout;
  for (std::size_t g = 0; g < groups.size(); ++g) {
    if (groups[g].empty()) continue;
    const Part part = splitter.split(groups[g]);
    const bool textured = !appearance.texture_coordinates.values.empty();
    const Scene::Material material =
        appearance.materials.empty() ? Scene::Material{"surface", {0.8f, 0.8f, 0.8f, 1.0f}, {}, {}} : appearance.materials[g];
    Json primitive{{"attributes", attributes_of(writer, part, mesh, smooth, appearance)}, {"indices", writer.scalars(part.corners)}};
    primitive["material"] = add_material(document, material, textured, changes);
    layout.blocks.push_back(
        {primitive["attributes"]["POSITION"].get<std::size_t>(), source.asset_vertices.size(), part.splits.size(), false});
    layout.primitives.push_back({layout.blocks.size() - 1});
    for (const Split& s : part.splits) source.asset_vertices.push_back(s.vertex);
    document.json["meshes"][0]["primitives"].push_back(std::move(primitive));
  }
  if (layout.blocks.empty()) throw Error("no face has three different vertices");
  source.layouts.push_back(std::move(layout));
  return source;
}

std::vector<PlacedInstance> fresh_instances() { return {{Scene::Instance{0, 0, std::nullopt}, 0, 0, Eigen::Affine3d::Identity(), {}}}; }

}  // namespace osteon::io::gltf
