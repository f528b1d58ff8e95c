// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "osteon/io/bytes.h"
#include "osteon/io/scene.h"

namespace osteon::io {

// A file as the importers see it. Each importer is a function File -> Scene that throws Error (without the file's name, which its caller
// adds) if nothing useful is there, and adds what it repaired to `repairs`.
struct File {
  std::filesystem::path path;  // to find files beside it
  std::span<const std::uint8_t> bytes;
  std::vector<std::string>& repairs;

  std::string_view text() const { return text_of(bytes); }
};

// A scene of one node that shows one mesh.
inline Scene scene_of(Scene::Mesh mesh, std::vector<Scene::Material> materials = {}) {
  Scene scene;
  scene.nodes.push_back({"", std::nullopt, Eigen::Affine3d::Identity()});
  scene.meshes.push_back(std::move(mesh));
  scene.materials = std::move(materials);
  scene.instances.push_back({0, 0, std::nullopt});
  return scene;
}

}  // namespace osteon::io
