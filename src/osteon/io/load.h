// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "osteon/mesh/triangle_mesh.h"
#include "osteon/rig/skeleton.h"
#include "osteon/rig/skin_weights.h"

namespace osteon::io {

struct SourceDocument;  // what save_glb needs to give the asset back as it came; see source_document.h

enum class UpAxis { x, y, z };

// A file that came in: one mesh, one skeleton at most. Satisfies validate(mesh), validate(*skeleton), validate(*weights, ...).
struct Asset {
  std::filesystem::path path;
  TriangleMesh mesh;                     // all meshes of the scene merged; world space, metres, y up; vertices in the file's order
  std::optional<Skeleton> skeleton;      // joints of all skins, one root, in the rest pose that `mesh` stands in
  std::optional<SkinWeights> weights;    // one row per vertex; present exactly when `skeleton` is and something is skinned to it
  UpAxis up = UpAxis::y;                 // the axis of the file that was taken for its up axis, and so was turned to y
  std::vector<std::string> repairs;      // what was wrong with the file and what was done about it, and what of it is left out
  std::vector<std::string> rig_repairs;  // the same of the rig that it has: nothing to those who give it another
  std::shared_ptr<const SourceDocument> source;
};

struct LoadOptions {
  std::optional<UpAxis> up;    // the axis of the file that points up; by default what the file says, or else y
  std::optional<float> scale;  // metres in one unit of the file; by default what the file says, or else 1
};

// Reads a character of any known format, told by its content first and by its extension second:
//   GLB, glTF, OBJ, PLY, STL, RigNet's rig.txt (with its OBJ beside it), and through Assimp FBX, DAE, 3DS and others.
// Skinned meshes are brought to the rest pose of their joints: v = sum of w_j * world_j * inverse_bind_j * v.
// Throws Error naming the file and the element when nothing useful can be read.
Asset load(const std::filesystem::path& path, const LoadOptions& options = {});

// The joints of a GLB, glTF, FBX, DAE or rig.txt alone; throws Error if there are none.
Skeleton load_skeleton(const std::filesystem::path& path, const LoadOptions& options = {});

struct SkeletonSource;  // see source_document.h

// A skeleton, and what save_glb needs to write it as it came.
struct SkeletonFile {
  Skeleton skeleton;                             // as load_skeleton gives it
  std::shared_ptr<const SkeletonSource> source;  // null where the file is no glTF
};
SkeletonFile load_skeleton_file(const std::filesystem::path& path, const LoadOptions& options = {});

}  // namespace osteon::io
