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

// What becomes of joint names that some program does not accept.
enum class JointNames {
  portable,  // ASCII without ':' and '/', different from those of all other nodes
  as_given,
};

struct SaveOptions {
  int max_influences = 4;  // joints per vertex, 1..8; above 4 a second set of attributes is written (JOINTS_1)
  WeightFormat weights = WeightFormat::f32;
  Vertices vertices = Vertices::keep;
  JointNames names = JointNames::portable;
};

// Writes `asset` with the given skeleton and weights (one row per vertex of asset.mesh) as a GLB.
// An asset that came from glTF goes out with its materials, textures, names, extras, extensions and vertex data as they were; the rig
// that it had, and its animations, are replaced; what hung from its joints (sockets, cameras, props) hangs from the nearest new ones, with
// the animations of its own. Any other asset becomes a new GLB with its objects, normals, texture coordinates, colours, materials and
// morph targets.
// Returns what had to be changed in the asset to make that possible. The file is written aside and renamed.
// Throws Error if the file cannot be written or the rig breaks an invariant.
std::vector<std::string> save_glb(const std::filesystem::path& path, const Asset& asset, const Skeleton& skeleton,
                                  const SkinWeights& weights, const SaveOptions& options = {});

// The same with the skeleton of another file, moved by `fit` (a similarity, y up and metres on both sides). A skeleton from glTF goes in
// with its nodes as they were: names, order, transforms and extras bit by bit; what `fit` asks for is done by one node above them.
// But where a joint is scaled to nothing, which no mesh can be bound to, the skeleton is written anew, and the changes say so.
// Otherwise, and where `fit` is the identity, joint names are as given.
std::vector<std::string> save_glb(const std::filesystem::path& path, const Asset& asset, const SkeletonFile& skeleton,
                                  const Eigen::Affine3d& fit, const SkinWeights& weights, SaveOptions options = {});

// Writes an asset that came from glTF with other weights for the skeleton that it has: everything else, joints, inverse bind matrices and
// animations too, stays as it was. Returns what had to be changed beyond that: a skin that lacks joints which the weights need gets them at
// its end; meshes that do not stand in their bind pose are rewritten as they stand, which becomes their bind pose; units and up axis of
// LoadOptions are brought to ours by a node above each root. Only where a joint is scaled to nothing, which no mesh can be bound to, the
// skeleton is replaced as by save_glb. Pre: asset.skeleton is there.
std::vector<std::string> save_weights(const std::filesystem::path& path, const Asset& asset, const SkinWeights& weights,
                                      const SaveOptions& options = {});

// The mesh alone: `v` and `f` lines, vertices and faces in order.
void save_obj(const std::filesystem::path& path, const TriangleMesh& mesh);

}  // namespace osteon::io
