// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/scene_bytes.h"

#include <cstring>
#include <type_traits>

#include "osteon/base/error.h"

namespace osteon::io {
namespace {

// Types whose bytes are all there is to them; Eigen's of fixed size are, though they are not trivially copyable by the letter.
template <class T>
constexpr bool kPlain =
    std::is_arithmetic_v<T> || std::is_enum_v<T> || std::is_same_v<T, Triangle> || std::is_same_v<T, Scene::Influence> ||
    std::is_same_v<T, std::array<std::uint32_t, 3>> || std::is_same_v<T, Vec3f> || std::is_same_v<T, Eigen::Vector2f> ||
    std::is_same_v<T, Eigen::Vector4f> || std::is_same_v<T, Eigen::Affine3d>;

class Saver {
 public:
  Bytes take() { return std::move(out_); }

  void raw(const void* data, std::size_t size) {
    const auto* bytes = static_cast<const std::uint8_t*>(data);
    out_.insert(out_.end(), bytes, bytes + size);
  }
  std::size_t length(std::size_t n) {
    raw(&n, sizeof n);
    return n;
  }

 private:
  Bytes out_;
};

class Loader {
 public:
  explicit Loader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

  void raw(void* data, std::size_t size) {
    if (size > bytes_.size()) throw Error("the reader's result is cut short");
    if (size > 0) std::memcpy(data, bytes_.data(), size);
    bytes_ = bytes_.subspan(size);
  }
  std::size_t length(std::size_t) {
    std::size_t n = 0;
    raw(&n, sizeof n);
    if (n > bytes_.size()) throw Error("the reader's result is cut short");  // every item takes a byte or more
    return n;
  }

 private:
  std::span<const std::uint8_t> bytes_;
};

// One list of fields serves both ways.
template <class Archive, class T>
void pass(Archive& archive, T& value) requires kPlain<T> {
  archive.raw(&value, sizeof value);
}

template <class Archive>
void pass(Archive& archive, std::string& text) {
  text.resize(archive.length(text.size()));
  archive.raw(text.data(), text.size());
}

template <class Archive>
void pass(Archive& archive, std::filesystem::path& path) {
  std::string text = path.string();
  pass(archive, text);
  path = text;
}

template <class Archive>
void pass(Archive& archive, std::optional<std::size_t>& value) {
  std::size_t number = value.value_or(SIZE_MAX);
  archive.raw(&number, sizeof number);
  value = number == SIZE_MAX ? std::nullopt : std::optional(number);
}

template <class Archive>
void pass(Archive& archive, Scene::Node& node);
template <class Archive>
void pass(Archive& archive, Scene::Texture& texture);
template <class Archive>
void pass(Archive& archive, Scene::Material& material);
template <class Archive>
void pass(Archive& archive, Scene::Morph& morph);
template <class Archive>
void pass(Archive& archive, Scene::Mesh& mesh);
template <class Archive>
void pass(Archive& archive, Scene::Skin& skin);
template <class Archive>
void pass(Archive& archive, Scene::Instance& instance);

template <class Archive, class T>
void pass(Archive& archive, std::vector<T>& items) {
  items.resize(archive.length(items.size()));
  if constexpr (kPlain<T>)
    archive.raw(items.data(), items.size() * sizeof(T));
  else
    for (T& item : items) pass(archive, item);
}

template <class Archive, class T>
void pass(Archive& archive, Scene::Layer<T>& layer) {
  pass(archive, layer.values);
  pass(archive, layer.corners);
}

template <class Archive, class... Fields>
void pass_all(Archive& archive, Fields&... fields) {
  (pass(archive, fields), ...);
}

template <class Archive>
void pass(Archive& archive, Scene::Node& node) {
  pass_all(archive, node.name, node.parent, node.world);
}
template <class Archive>
void pass(Archive& archive, Scene::Texture& texture) {
  pass_all(archive, texture.file, texture.image, texture.coordinate_set);
}
template <class Archive>
void pass(Archive& archive, Scene::Material& material) {
  pass_all(archive, material.name, material.colour, material.metallic, material.roughness, material.base, material.normals);
}
template <class Archive>
void pass(Archive& archive, Scene::Morph& morph) {
  pass_all(archive, morph.name, morph.offsets);
}
template <class Archive>
void pass(Archive& archive, Scene::Mesh& mesh) {
  pass_all(archive, mesh.positions, mesh.faces, mesh.normals, mesh.texture_coordinates, mesh.coordinates_after, mesh.colours, mesh.morphs,
           mesh.face_materials, mesh.objects, mesh.face_objects, mesh.influence_offsets, mesh.influences);
}
template <class Archive>
void pass(Archive& archive, Scene::Skin& skin) {
  pass_all(archive, skin.joints, skin.inverse_binds);
}
template <class Archive>
void pass(Archive& archive, Scene::Instance& instance) {
  pass_all(archive, instance.node, instance.mesh, instance.skin);
}

template <class Archive>
void pass_scene(Archive& archive, Scene& scene, std::vector<std::string>& repairs) {
  pass_all(archive, scene.nodes, scene.materials, scene.meshes, scene.skins, scene.instances, scene.up, scene.metres_per_unit, repairs);
}

}  // namespace

Bytes to_bytes(Scene& scene, std::vector<std::string>& repairs) {
  Saver saver;
  pass_scene(saver, scene, repairs);
  return saver.take();
}

Scene scene_of_bytes(std::span<const std::uint8_t> bytes, std::vector<std::string>& repairs) {
  Loader loader(bytes);
  Scene scene;
  std::vector<std::string> made;
  pass_scene(loader, scene, made);
  repairs.insert(repairs.end(), made.begin(), made.end());
  return scene;
}

}  // namespace osteon::io
