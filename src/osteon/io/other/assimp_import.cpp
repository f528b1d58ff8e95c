// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/other/assimp_import.h"

#include <assimp/commonMetaData.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <map>

#include "osteon/base/error.h"
#include "osteon/io/isolated.h"
#include "osteon/io/scene_bytes.h"

namespace osteon::io::other {
namespace {

// Assimp chooses its reader by extension first: tell it what the content says where that is known.
std::string hint(const File& file) {
  const std::string_view text = file.text();
  if (text.starts_with("Kaydara FBX Binary") || text.starts_with("; FBX")) return "fbx";
  if (text.substr(0, 4096).find("<COLLADA") != std::string_view::npos) return "dae";
  const std::string extension = file.path.extension().string();
  return extension.empty() ? "" : extension.substr(1);
}

Eigen::Affine3d transform_of(const aiMatrix4x4& m) {
  Eigen::Affine3d out;
  out.matrix() << m.a1, m.a2, m.a3, m.a4, m.b1, m.b2, m.b3, m.b4, m.c1, m.c2, m.c3, m.c4, 0, 0, 0, 1;
  return out;
}

class Converter {
 public:
  Converter(const aiScene& source, const File& file) : source_(source), file_(file) {}

  Scene run() {
    if (source_.mRootNode) add_nodes();
    for (const aiMaterial* material : std::span(source_.mMaterials, source_.mNumMaterials))
      scene_.materials.push_back(material_of(*material));
    for (const aiMesh* mesh : std::span(source_.mMeshes, source_.mNumMeshes)) add_mesh(*mesh);
    for (std::size_t n = 0; n < nodes_.size(); ++n)
      for (const unsigned m : std::span(nodes_[n]->mMeshes, nodes_[n]->mNumMeshes)) {
        if (m >= scene_.meshes.size())
          throw Error("node '{}' shows mesh {}, but there are {}", scene_.nodes[n].name, m, scene_.meshes.size());
        scene_.instances.push_back({n, m, skin_of_mesh_[m]});
      }
    if (lost_bones_ > 0) file_.repairs.push_back(fmt::format("{} bones have no node; left out", lost_bones_));
    read_units();
    tell_losses();
    return std::move(scene_);
  }

 private:
  // Breadth first: parents before children, no recursion.
  void add_nodes() {
    std::vector<std::optional<std::size_t>> parents{std::nullopt};
    nodes_.push_back(source_.mRootNode);
    for (std::size_t n = 0; n < nodes_.size(); ++n) {
      const aiNode& node = *nodes_[n];
      const Eigen::Affine3d above = parents[n] ? scene_.nodes[*parents[n]].world : Eigen::Affine3d::Identity();
      scene_.nodes.push_back({node.mName.C_Str(), parents[n], above * transform_of(node.mTransformation)});
      node_of_name_.emplace(node.mName.C_Str(), n);
      for (const aiNode* child : std::span(node.mChildren, node.mNumChildren)) {
        nodes_.push_back(child);
        parents.push_back(n);
      }
    }
  }

  Scene::Material material_of(const aiMaterial& source) const {
    Scene::Material material;
    aiString text;
    aiColor3D colour;
    float opacity = 1.0f;
    if (source.Get(AI_MATKEY_NAME, text) == AI_SUCCESS) material.name = text.C_Str();
    if (source.Get(AI_MATKEY_COLOR_DIFFUSE, colour) == AI_SUCCESS) material.colour.head<3>() << colour.r, colour.g, colour.b;
    if (source.Get(AI_MATKEY_OPACITY, opacity) == AI_SUCCESS) material.colour[3] = opacity;
    for (float& c : material.colour) c = std::isfinite(c) ? std::clamp(c, 0.0f, 1.0f) : 1.0f;
    source.Get(AI_MATKEY_ROUGHNESS_FACTOR, material.roughness);
    if (source.Get(AI_MATKEY_METALLIC_FACTOR, material.metallic) != AI_SUCCESS && is_by_blender_)
      source.Get(AI_MATKEY_REFLECTIVITY, material.metallic);
    const auto mend = [](float& share, float otherwise) { share = std::isfinite(share) ? std::clamp(share, 0.0f, 1.0f) : otherwise; };
    mend(material.metallic, 0.0f);
    mend(material.roughness, 1.0f);
    material.base = texture_of(source, {aiTextureType_DIFFUSE, aiTextureType_BASE_COLOR});
    material.normals = texture_of(source, {aiTextureType_NORMALS, aiTextureType_NORMAL_CAMERA});
    return material;
  }

  // Of the first kind that the material has.
  Scene::Texture texture_of(const aiMaterial& source, std::initializer_list<aiTextureType> kinds) const {
    Scene::Texture texture;
    aiString text;
    unsigned set = 0;
    for (const aiTextureType kind : kinds) {
      if (source.GetTexture(kind, 0, &text, nullptr, &set) != AI_SUCCESS) continue;
      texture.coordinate_set = set;
      if (const aiTexture* embedded = source_.GetEmbeddedTexture(text.C_Str()); embedded && embedded->mHeight == 0) {
        const auto* bytes = reinterpret_cast<const std::uint8_t*>(embedded->pcData);
        texture.image.assign(bytes, bytes + embedded->mWidth);  // a compressed picture: mWidth is its size in bytes
      }
      std::string name = text.C_Str();
      std::replace(name.begin(), name.end(), '\\', '/');
      texture.file = file_.path.parent_path() / std::filesystem::path(name).filename();  // absolute paths are another machine's
      if (const auto relative = file_.path.parent_path() / name; !std::filesystem::path(name).is_absolute()) texture.file = relative;
      break;
    }
    return texture;
  }

  void add_mesh(const aiMesh& source) {
    Scene::Mesh mesh;
    for (const aiVector3D& p : std::span(source.mVertices, source.mNumVertices)) mesh.positions.emplace_back(p.x, p.y, p.z);
    std::vector<std::array<std::uint32_t, 3>> corners;
    for (const aiFace& face : std::span(source.mFaces, source.mNumFaces)) {
      if (face.mNumIndices != 3) continue;  // points and lines
      const auto* i = face.mIndices;
      if (std::max({i[0], i[1], i[2]}) >= source.mNumVertices)
        throw Error("mesh '{}' has a face with an index beyond its {} vertices", source.mName.C_Str(), source.mNumVertices);
      corners.push_back({i[0], i[1], i[2]});
      mesh.faces.push_back({VertexId{i[0]}, VertexId{i[1]}, VertexId{i[2]}});
    }
    if (source.HasNormals())
      for (const aiVector3D& n : std::span(source.mNormals, source.mNumVertices)) mesh.normals.values.emplace_back(n.x, n.y, n.z);
    for (unsigned set = 0; set < source.GetNumUVChannels(); ++set) add_coordinates(source, set, mesh);
    if (source.HasVertexColors(0))
      for (const aiColor4D& c : std::span(source.mColors[0], source.mNumVertices)) mesh.colours.emplace_back(c.r, c.g, c.b, c.a);
    if (!mesh.normals.values.empty()) mesh.normals.corners = corners;
    if (!mesh.texture_coordinates.values.empty()) mesh.texture_coordinates.corners = corners;
    if (source.mMaterialIndex < scene_.materials.size()) mesh.face_materials.assign(mesh.faces.size(), source.mMaterialIndex);
    for (const aiAnimMesh* shape : std::span(source.mAnimMeshes, source.mNumAnimMeshes)) add_morph(source, *shape, mesh);
    skin_of_mesh_.push_back(add_skin(source, mesh));
    scene_.meshes.push_back(std::move(mesh));
  }

  static void add_coordinates(const aiMesh& source, unsigned set, Scene::Mesh& mesh) {
    auto& values = set == 0 ? mesh.texture_coordinates.values : mesh.coordinates_after.emplace_back();
    for (const aiVector3D& t : std::span(source.mTextureCoords[set], source.mNumVertices))
      values.push_back(std::isfinite(t.x) && std::isfinite(t.y) ? Eigen::Vector2f(t.x, 1.0f - t.y) : Eigen::Vector2f(0.0f, 0.0f));
  }

  // Assimp gives the places to which a shape moves the vertices.
  static void add_morph(const aiMesh& source, const aiAnimMesh& shape, Scene::Mesh& mesh) {
    if (!shape.HasPositions() || shape.mNumVertices != source.mNumVertices) return;
    Scene::Morph morph{shape.mName.C_Str(), {}};
    for (unsigned v = 0; v < source.mNumVertices; ++v) {
      const aiVector3D offset = shape.mVertices[v] - source.mVertices[v];
      morph.offsets.emplace_back(offset.x, offset.y, offset.z);
    }
    mesh.morphs.push_back(std::move(morph));
  }

  std::optional<std::size_t> add_skin(const aiMesh& source, Scene::Mesh& mesh) {
    Scene::Skin skin;
    std::vector<std::vector<Scene::Influence>> rows(source.mNumBones > 0 ? mesh.positions.size() : 0);
    for (const aiBone* bone : std::span(source.mBones, source.mNumBones)) {
      const auto node = node_of_name_.find(bone->mName.C_Str());
      if (node == node_of_name_.end()) {
        ++lost_bones_;
        continue;
      }
      const auto joint = static_cast<std::uint32_t>(skin.joints.size());
      skin.joints.push_back(node->second);
      skin.inverse_binds.push_back(transform_of(bone->mOffsetMatrix));
      if (!skin.inverse_binds.back().matrix().allFinite()) throw Error("bone '{}' has a bind pose that is not finite", bone->mName.C_Str());
      for (const aiVertexWeight& w : std::span(bone->mWeights, bone->mNumWeights))
        if (w.mVertexId < rows.size() && w.mWeight > 0.0f && std::isfinite(w.mWeight)) rows[w.mVertexId].push_back({joint, w.mWeight});
    }
    if (skin.joints.empty()) return std::nullopt;
    mesh.influence_offsets = {0};
    for (const auto& row : rows) {
      mesh.influences.insert(mesh.influences.end(), row.begin(), row.end());
      mesh.influence_offsets.push_back(static_cast<std::uint32_t>(mesh.influences.size()));
    }
    scene_.skins.push_back(std::move(skin));
    return scene_.skins.size() - 1;
  }

  // FBX: Assimp leaves units (centimetres times the factor) and axes as the file has them. Its Collada reader has applied both already.
  void read_units() {
    if (!source_.mMetaData) return;
    float centimetres = 0.0f;
    std::int32_t up = 1;
    if (source_.mMetaData->Get("UnitScaleFactor", centimetres) && centimetres > 0.0f && std::isfinite(centimetres))
      scene_.metres_per_unit = static_cast<double>(centimetres) / 100.0;
    if (source_.mMetaData->Get("UpAxis", up)) scene_.up = up == 0 ? UpAxis::x : up == 2 ? UpAxis::z : UpAxis::y;
  }

  void tell_losses() const {
    const auto tell = [&](const std::string& what) { file_.repairs.push_back("left out " + what); };
    if (source_.mNumAnimations > 0) {
      std::vector<std::string> names;
      for (const aiAnimation* animation : std::span(source_.mAnimations, source_.mNumAnimations))
        names.push_back(fmt::format("'{}'", animation->mName.C_Str()));
      tell(fmt::format("{} animations: {}", names.size(), fmt::join(names, ", ")));
    }
    for (const auto& [kind, count] : textures_left_out()) tell(fmt::format("the {} textures of {} materials", kind, count));
    if (source_.mNumCameras > 0) tell(fmt::format("{} cameras", source_.mNumCameras));
    if (source_.mNumLights > 0) tell(fmt::format("{} lights", source_.mNumLights));
    const auto has_more_colours = [](const aiMesh* mesh) { return mesh->HasVertexColors(1); };
    const auto coloured = std::ranges::count_if(std::span(source_.mMeshes, source_.mNumMeshes), has_more_colours);
    if (coloured > 0) tell(fmt::format("all vertex colours but the first set of {} meshes", coloured));
  }

  // Kinds of textures that do not come out, and how many materials have them.
  std::map<std::string, std::size_t> textures_left_out() const {
    std::map<std::string, std::size_t> out;
    for (const aiMaterial* material : std::span(source_.mMaterials, source_.mNumMaterials))
      for (int k = aiTextureType_NONE + 1; k <= AI_TEXTURE_TYPE_MAX; ++k) {
        const auto kind = static_cast<aiTextureType>(k);
        const auto has = [&](aiTextureType other) { return material->GetTextureCount(other) > 0; };
        const bool is_kept = kind == aiTextureType_DIFFUSE || kind == aiTextureType_NORMALS ||
                             (kind == aiTextureType_BASE_COLOR && !has(aiTextureType_DIFFUSE)) ||
                             (kind == aiTextureType_NORMAL_CAMERA && !has(aiTextureType_NORMALS));
        if (!is_kept && has(kind)) ++out[aiTextureTypeToString(kind)];
      }
    return out;
  }

  // Blender writes what is metallic as a reflection factor; others mean something else by it.
  static bool is_by_blender(const aiScene& source) {
    aiString generator;
    return source.mMetaData && source.mMetaData->Get(AI_METADATA_SOURCE_GENERATOR, generator) &&
           std::string_view(generator.C_Str()).starts_with("Blender");
  }

  const aiScene& source_;
  const File& file_;
  const bool is_by_blender_ = is_by_blender(source_);
  Scene scene_;
  std::vector<const aiNode*> nodes_;
  std::map<std::string, std::size_t> node_of_name_;
  std::vector<std::optional<std::size_t>> skin_of_mesh_;
  std::size_t lost_bones_ = 0;
};

}  // namespace

Scene import_here(const File& file) {
  Assimp::Importer importer;
  importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, false);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_REMOVE_EMPTY_BONES, false);
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
  const unsigned steps = aiProcess_Triangulate | aiProcess_JoinIdenticalVertices | aiProcess_ValidateDataStructure;
  const aiScene* source = importer.ReadFileFromMemory(file.bytes.data(), file.bytes.size(), steps, hint(file).c_str());
  if (!source) throw Error("{}", importer.GetErrorString());
  return Converter(*source, file).run();
}

Scene import(const File& file) {
  const std::size_t megabytes = file.bytes.size() >> 20;
  const IsolationLimits limits{(std::size_t{2} << 30) + 64 * file.bytes.size(), static_cast<unsigned>(20 + 2 * megabytes)};
  const Bytes result = run_isolated(
      [&] {
        std::vector<std::string> repairs;
        Scene scene = import_here({file.path, file.bytes, repairs});
        return to_bytes(scene, repairs);
      },
      limits);
  return scene_of_bytes(result, file.repairs);
}

}  // namespace osteon::io::other
