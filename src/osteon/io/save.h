// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "osteon/io/load.h"

namespace osteon::io {

// How weights are stored: float, or integers that sum to exactly 255 or 65535 in each vertex.
enum class WeightFormat { f32, u8, u16 };

// What is done about a transform that the mesh of a glTF had above it (a skin makes viewers ignore that).
enum class Vertices {
  keep,  // vertices stay as they are, the inverse bind matrices take the transform up; rewritten only where one matrix cannot do it
  bake,  // vertices are rewritten in world space
};

struct SaveOptions {
  int max_influences = 4;  // joints per vertex, 1..8; above 4 a second set of attributes is written (JOINTS_1)
  WeightFormat weights = WeightFormat::f32;
  Vertices vertices = Vertices::keep;
};

// Writes `asset` with the given skeleton and weights (one row per vertex of asset.mesh) as a GLB.
// An asset that came from glTF goes out with its materials, textures, names, extras, extensions and vertex data as they were; the rig
// that it had, and its animations, are replaced. Any other asset becomes a new GLB with its normals, texture coordinates and colours.
// Returns what had to be changed in the asset to make that possible. The file is written aside and renamed.
// Throws Error if the file cannot be written or the rig breaks an invariant.
std::vector<std::string> save_glb(const std::filesystem::path& path, const Asset& asset, const Skeleton& skeleton,
                                  const SkinWeights& weights, const SaveOptions& options = {});

// The mesh alone: `v` and `f` lines, vertices and faces in order.
void save_obj(const std::filesystem::path& path, const TriangleMesh& mesh);

}  // namespace osteon::io
