// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/save.h"

#include <cassert>
#include <charconv>

#include "osteon/base/error.h"
#include "osteon/io/gltf/attach_rig.h"
#include "osteon/io/gltf/fresh.h"
#include "osteon/io/gltf/joint_nodes.h"

namespace osteon::io {
namespace {

constexpr const char* kWrittenAnew = "a joint is scaled to nothing, which no mesh can be bound to; the skeleton is written anew";

void check(const Asset& asset, const Skeleton& skeleton, const SkinWeights& weights, const SaveOptions& options) {
  validate(asset.mesh);
  validate(skeleton);
  validate(weights, asset.mesh.positions.size(), skeleton.size());
  if (options.max_influences < 1 || options.max_influences > 8)
    throw Error("max_influences is {}, expected 1 to 8", options.max_influences);
}

// The document of the asset, or a new one, given its rig by attach(document, instances, changes).
template <class Attach>
std::vector<std::string> save_document(const std::filesystem::path& path, const Asset& asset, std::size_t joints, const Attach& attach) {
  std::vector<std::string> changes;
  try {
    const bool from_gltf = asset.source && asset.source->gltf;
    const Appearance appearance = asset.source && asset.source->appearance ? *asset.source->appearance : Appearance{};
    const std::string name = asset.path.empty() ? "character" : asset.path.stem().string();
    gltf::Fresh document =
        from_gltf ? gltf::Fresh{*asset.source->gltf, asset.source->instances} : gltf::fresh_document(name, asset.mesh, appearance, changes);
    attach(document.source, document.instances, changes);
    if (joints > 254) changes.push_back(fmt::format("{} joints; viewers on Android show at most 254", joints));
    gltf::write_glb(path, document.source.document);
  } catch (const gltf::Json::exception& e) {  // parts of the document that reading the mesh had no need to look at
    throw Error("{}: malformed glTF: {}", asset.path.filename().string(), e.what());
  }
  return changes;
}

// A glTF's own rig is replaced, and said so, by attach_rig.
void tell_what_is_replaced(const Asset& asset, std::vector<std::string>& changes) {
  const bool from_gltf = asset.source && asset.source->gltf;
  if (asset.skeleton && !from_gltf)
    changes.push_back(fmt::format("replaced the rig that the asset had ({} joints)", asset.skeleton->size()));
}

std::vector<std::string> save_with_joints(const std::filesystem::path& path, const Asset& asset, const Skeleton& skeleton,
                                          const SkinWeights& weights, const SaveOptions& options) {
  check(asset, skeleton, weights, options);
  return save_document(path, asset, skeleton.size(), [&](GltfSource& document, const auto& instances, auto& changes) {
    gltf::attach_rig(document, instances, asset.mesh, skeleton, weights, options, changes);
  });
}

void append_number(std::string& text, float value) {
  char buffer[32];
  const auto [end, failure] = std::to_chars(buffer, buffer + sizeof buffer, value);  // shortest text that reads back the same
  text += ' ';
  text.append(buffer, end);
}

}  // namespace

std::vector<std::string> save_glb(const std::filesystem::path& path, const Asset& asset, const Skeleton& skeleton,
                                  const SkinWeights& weights, const SaveOptions& options) {
  std::vector<std::string> changes = save_with_joints(path, asset, skeleton, weights, options);
  tell_what_is_replaced(asset, changes);
  return changes;
}

std::vector<std::string> save_glb(const std::filesystem::path& path, const Asset& asset, const SkeletonFile& skeleton,
                                  const Eigen::Affine3d& fit, const SkinWeights& weights, SaveOptions options) {
  if (!skeleton.source || !gltf::can_copy_joint_nodes(*skeleton.source)) {
    options.names = JointNames::as_given;
    std::vector<std::string> changes = save_glb(path, asset, transformed(skeleton.skeleton, fit), weights, options);
    if (skeleton.source) changes.insert(changes.begin(), kWrittenAnew);
    return changes;
  }
  check(asset, skeleton.skeleton, weights, options);
  return save_document(path, asset, skeleton.skeleton.size(), [&](GltfSource& document, const auto& instances, auto& changes) {
    tell_what_is_replaced(asset, changes);
    gltf::attach_rig(document, instances, asset.mesh, skeleton, fit, weights, options, changes);
  });
}

std::vector<std::string> save_weights(const std::filesystem::path& path, const Asset& asset, const SkinWeights& weights,
                                      const SaveOptions& options) {
  assert(asset.skeleton);
  check(asset, *asset.skeleton, weights, options);
  const bool from_gltf = asset.source && asset.source->gltf;
  if (!from_gltf || !gltf::can_replace_weights(*asset.source)) {
    SaveOptions as_given = options;
    as_given.names = JointNames::as_given;
    std::vector<std::string> changes = save_with_joints(path, asset, *asset.skeleton, weights, as_given);
    if (from_gltf) changes.insert(changes.begin(), kWrittenAnew);
    return changes;
  }
  return save_document(path, asset, asset.skeleton->size(), [&](GltfSource& document, const auto& instances, auto& changes) {
    gltf::replace_weights(document, instances, asset.mesh, weights, options, changes);
  });
}

void save_obj(const std::filesystem::path& path, const TriangleMesh& mesh) {
  std::string text;
  for (const Vec3f& p : mesh.positions) {
    text += 'v';
    for (const float x : p) append_number(text, x);
    text += '\n';
  }
  for (const Triangle& face : mesh.faces) {
    text += 'f';
    for (const VertexId v : face) text += fmt::format(" {}", index(v) + 1);
    text += '\n';
  }
  const std::span<const std::uint8_t> bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  write_file(path, {&bytes, 1});
}

}  // namespace osteon::io
