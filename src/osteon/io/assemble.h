// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "osteon/io/scene.h"
#include "osteon/io/source_document.h"

namespace osteon::io {

// Makes the strict Asset of a tolerant Scene: instances merged in world space, metres, y up; joints of all skins as one tree with unique
// names; weights normalised. Meshes without a skin follow the nearest joint above them. What had to be repaired is added to asset.repairs
// and rig_repairs. Returns where each instance went. Throws Error (its text without the file's name) if there is no face, or far too many
// of them. On return the nodes' transforms in `scene` lead to our world.
std::vector<PlacedInstance> assemble(Scene& scene, const LoadOptions& options, Asset& asset);

// File's world -> ours: metres, y up.
Eigen::Affine3d import_transform(const Scene& scene, const LoadOptions& options);

// Makes the nodes' transforms lead to our world: metres, y up. assemble() does so first.
void to_our_world(Scene& scene, const LoadOptions& options);

// The transform that linear blend skinning applies to one vertex of a mesh; that of the first joint where the vertex has no weight.
// Influences of joints that do not exist are passed over. Pre: the mesh has influences, joint_to_world is not empty.
Eigen::Affine3d blended_transform(const Scene::Mesh& mesh, std::size_t vertex, std::span<const Eigen::Affine3d> joint_to_world);

// Normals turn with the inverse transpose; the cofactors are that up to a positive factor, and exist for singular transforms too.
Eigen::Matrix3d normal_matrix(const Eigen::Affine3d& transform);

}  // namespace osteon::io
