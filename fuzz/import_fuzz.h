// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/base/error.h"
#include "osteon/io/assemble.h"
#include "osteon/io/importer.h"

namespace osteon::io {

// What load() does with a file of one format. An Error is the right answer to a broken file; anything else that happens is a find.
template <class Import>
int fuzz_import(const char* name, const std::uint8_t* data, std::size_t size, Import import) {
  std::vector<std::string> repairs;
  try {
    Scene scene = import(File{name, {data, size}, repairs});
    for (Scene::Mesh& mesh : scene.meshes) repair_positions(mesh.positions);
    Asset asset;
    assemble(scene, {}, asset);
    validate(asset.mesh);
    if (asset.skeleton) validate(*asset.skeleton);
    if (asset.weights) validate(*asset.weights, asset.mesh.positions.size(), asset.skeleton->size());
  } catch (const Error&) {
  }
  return 0;
}

}  // namespace osteon::io
