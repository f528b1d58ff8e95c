// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/other/assimp_import.h"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

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
    if (source.GetTexture(aiTextureType_DIFFUSE, 0, &text) != AI_SUCCESS) return material;
    if (const aiTexture* embedded = source_.GetEmbeddedTexture(text.C_Str()); embedded && embedded->mHeight == 0) {
      const auto* bytes = reinterpret_cast<const std::uint8_t*>(embedded->pcData);
      material.image.assign(bytes, bytes + embedded->mWidth);  // a compressed picture: mWidth is its size in bytes
    }
    std::string name = text.C_Str();
    std::replace(name.begin(), name.end(), '\\', '/');
    material.texture = file_.path.parent_path() / std::filesystem::path(name).filename();  // absolute paths are another machine's
    if (const auto relative = file_.path.parent_path() / name; !std::filesystem::path(name).is_absolute()) material.texture = relative;
    return material;
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
    if (source.HasTextureCoords(0))
      for (const aiVector3D& t : std::span(source.mTextureCoords[0], source.mNumVertices))
        mesh.texture_coordinates.values.push_back(std::isfinite(t.x) && std::isfinite(t.y) ? Eigen::Vector2f(t.x, 1.0f - t.y)
                                                                                           : Eigen::Vector2f(0.0f, 0.0f));
    if (source.HasVertexColors(0))
      for (const aiColor4D& c : std::span(source.mColors[0], source.mNumVertices)) mesh.colours.emplace_back(c.r, c.g, c.b, c.a);
    if (!mesh.normals.values.empty()) mesh.normals.corners = corners;
    if (!mesh.texture_coordinates.values.empty()) mesh.texture_coordinates.corners = corners;
    if (source.mMaterialIndex < scene_.materials.size()) mesh.face_materials.assign(mesh.faces.size(), source.mMaterialIndex);
    skin_of_mesh_.push_back(add_skin(source, mesh));
    scene_.meshes.push_back(std::move(mesh));
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

  const aiScene& source_;
  const File& file_;
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
