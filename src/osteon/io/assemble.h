// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "osteon/io/scene.h"
#include "osteon/io/source_document.h"

namespace osteon::io {

// Makes the strict Asset of a tolerant Scene: instances merged in world space, metres, y up; joints of all skins as one tree with unique
// names; weights normalised. Meshes without a skin follow the nearest joint above them. What had to be repaired is added to asset.repairs.
// Returns where each instance went. Throws Error (its text without the file's name) if there is no vertex, or far too many of them.
std::vector<PlacedInstance> assemble(Scene&& scene, const LoadOptions& options, Asset& asset);

// The transform that linear blend skinning applies to one vertex of a mesh; that of the first joint where the vertex has no weight.
// Influences of joints that do not exist are passed over. Pre: the mesh has influences, joint_to_world is not empty.
Eigen::Affine3d blended_transform(const Scene::Mesh& mesh, std::size_t vertex, std::span<const Eigen::Affine3d> joint_to_world);

}  // namespace osteon::io
