// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/texture_files.h"

#include "osteon/io/source_document.h"

namespace osteon::io {
namespace {

// The URIs of images that are not in the document itself. Whatever is malformed is told when it is used.
std::vector<std::string> image_uris(const gltf::Json& document) {
  std::vector<std::string> uris;
  if (const auto images = document.find("images"); images != document.end())
    for (const gltf::Json& image : *images)
      if (image.is_object() && image.contains("uri") && image["uri"].is_string()) uris.push_back(image["uri"].get<std::string>());
  std::erase_if(uris, [](const std::string& uri) { return uri.starts_with("data:"); });
  return uris;
}

}  // namespace

std::vector<std::filesystem::path> texture_files(const Asset& asset) {
  std::vector<std::filesystem::path> files;
  if (!asset.source) return files;
  if (const auto& appearance = asset.source->appearance)
    for (const Scene::Material& material : appearance->materials)
      for (const Scene::Texture* texture : {&material.base, &material.normals})
        if (texture->image.empty()) files.push_back(texture->file);
  if (const auto& gltf = asset.source->gltf)
    for (const std::string& uri : image_uris(gltf->document.json))
      files.push_back(gltf->document.path.parent_path() / gltf::decode_percent(uri));
  std::error_code missing;
  std::erase_if(files, [&](const auto& file) { return !std::filesystem::exists(file, missing); });
  return files;
}

}  // namespace osteon::io
