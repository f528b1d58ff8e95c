// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/load.h"

#include "osteon/base/error.h"
#include "osteon/io/appearance.h"
#include "osteon/io/assemble.h"
#include "osteon/io/format.h"
#include "osteon/io/gltf/import.h"
#include "osteon/io/importer.h"
#include "osteon/io/joint_tree.h"
#include "osteon/io/obj/obj.h"
#include "osteon/io/other/assimp_import.h"
#include "osteon/io/ply/ply.h"
#include "osteon/io/rigtxt.h"
#include "osteon/io/source_document.h"
#include "osteon/io/stl/stl.h"

namespace osteon::io {
namespace {

// A file read but not yet made strict.
struct Loose {
  Scene scene;
  SourceDocument source;
  std::vector<std::string> repairs;
};

void read_gltf(const std::filesystem::path& path, Bytes bytes, Loose& loose) {
  loose.source.gltf = GltfSource{gltf::parse(path, std::move(bytes), loose.repairs), {}, {}};
  auto [scene, layouts] = gltf::import_scene(loose.source.gltf->document, loose.repairs);
  loose.source.gltf->layouts = std::move(layouts);
  loose.scene = std::move(scene);
}

Scene read_scene(Format format, const File& file) {
  switch (format) {
    case Format::obj:
      return obj::import(file);
    case Format::ply:
      return ply::import(file);
    case Format::stl:
      return stl::import(file);
    case Format::rigtxt:
      return rigtxt::import(file);
    case Format::gltf:
    case Format::other:
      break;
  }
  return other::import(file);
}

Loose read(const std::filesystem::path& path) {
  Bytes bytes = utf8_of(read_file(path));
  const Format format = format_of(path, bytes);
  Loose loose;
  if (format == Format::gltf) {
    read_gltf(path, std::move(bytes), loose);
    return loose;
  }
  loose.scene = read_scene(format, {path, bytes, loose.repairs});
  std::size_t repaired = 0, vertices = 0;
  for (Scene::Mesh& mesh : loose.scene.meshes) {
    vertices += mesh.positions.size();
    repaired += repair_positions(mesh.positions);
  }
  if (repaired > 0 && repaired == vertices) throw Error("none of the {} vertices is finite", vertices);
  if (repaired > 0) loose.repairs.push_back(fmt::format("moved {} vertices with coordinates that are not finite to the origin", repaired));
  return loose;
}

Asset make_strict(Loose loose, const LoadOptions& options) {
  Asset asset;
  asset.repairs = std::move(loose.repairs);
  if (loose.source.gltf) loose.source.gltf->to_world = import_transform(loose.scene, options);
  loose.source.instances = assemble(loose.scene, options, asset);
  if (!loose.source.gltf) loose.source.appearance = merged_appearance(loose.scene, loose.source.instances);
  asset.source = std::make_shared<const SourceDocument>(std::move(loose.source));
  validate(asset.mesh);
  if (asset.skeleton) validate(*asset.skeleton);
  if (asset.weights) validate(*asset.weights, asset.mesh.positions.size(), asset.skeleton->size());
  return asset;
}

// Every Error names the file.
template <class Work>
auto naming(const std::filesystem::path& path, Work work) {
  try {
    return work();
  } catch (const Error& e) {
    const std::string file = path.filename().string(), text = e.what();
    if (text.find(file) != std::string::npos) throw;
    throw Error("{}: {}", file, text);
  }
}

}  // namespace

Asset load(const std::filesystem::path& path, const LoadOptions& options) {
  return naming(path, [&] {
    if (options.scale && !(*options.scale > 0.0f && std::isfinite(*options.scale)))
      throw Error("scale {}, expected a positive number", *options.scale);
    Asset asset = make_strict(read(path), options);
    asset.path = path;
    return asset;
  });
}

SkeletonFile load_skeleton_file(const std::filesystem::path& path, const LoadOptions& options) {
  return naming(path, [&] {
    Loose loose = read(path);
    const Eigen::Affine3d to_world = import_transform(loose.scene, options);
    to_our_world(loose.scene, options);
    auto joints = joint_tree(loose.scene, loose.repairs);
    if (!joints) joints = joint_tree_of_nodes(loose.scene, loose.repairs);
    if (!joints) throw Error("no joints");
    validate(joints->skeleton);
    SkeletonFile out{std::move(joints->skeleton), nullptr};
    if (loose.source.gltf)
      out.source = std::make_shared<const SkeletonSource>(
          SkeletonSource{std::move(loose.source.gltf->document), nodes_of_joints(*joints, out.skeleton.size()), to_world});
    return out;
  });
}

Skeleton load_skeleton(const std::filesystem::path& path, const LoadOptions& options) { return load_skeleton_file(path, options).skeleton; }

}  // namespace osteon::io
