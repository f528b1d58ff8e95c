// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/load.h"

#include <cassert>

#include "osteon/base/error.h"
#include "osteon/io/assemble.h"
#include "osteon/io/bytes.h"
#include "osteon/io/gltf/document.h"
#include "osteon/io/gltf/import.h"
#include "osteon/io/source_document.h"

namespace osteon::io {
namespace {

Asset load_gltf(const std::filesystem::path& path, Bytes bytes, const LoadOptions& options) {
  Asset asset;
  SourceDocument source;
  source.gltf = GltfSource{gltf::parse(path, std::move(bytes), asset.repairs), {}, {}};
  auto [scene, layouts] = gltf::import_scene(source.gltf->document, asset.repairs);
  source.gltf->layouts = std::move(layouts);
  source.instances = assemble(std::move(scene), options, asset);
  asset.source = std::make_shared<const SourceDocument>(std::move(source));
  return asset;
}

// Errors of readers that do not know the file's name get it here.
Asset load_any(const std::filesystem::path& path, const LoadOptions& options) {
  Bytes bytes = read_file(path);
  if (gltf::is_gltf(bytes)) return load_gltf(path, std::move(bytes), options);
  throw Error("{}: unknown format", path.filename().string());
}

}  // namespace

Asset load(const std::filesystem::path& path, const LoadOptions& options) {
  Asset asset = load_any(path, options);
  asset.path = path;
  validate(asset.mesh);
  if (asset.skeleton) validate(*asset.skeleton);
  if (asset.weights) validate(*asset.weights, asset.mesh.positions.size(), asset.skeleton->size());
  return asset;
}

Skeleton load_skeleton(const std::filesystem::path& path, const LoadOptions& options) {
  Asset asset = load(path, options);
  if (!asset.skeleton) throw Error("{}: no joints", path.filename().string());
  return *std::move(asset.skeleton);
}

}  // namespace osteon::io
