// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/io/save.h"
#include "osteon/io/source_document.h"

namespace osteon::io::gltf {

// Gives the meshes of `source` the skeleton and weights (of the vertices of `mesh`, world space), in place of any rig they had, and brings
// the document into the form of one GLB. What had to be changed beyond that is added to `changes`.
// Pre: `mesh` is what the document was read as, or built from; the rig is valid for it.
void attach_rig(GltfSource& source, const std::vector<PlacedInstance>& instances, const TriangleMesh& mesh, const Skeleton& skeleton,
                const SkinWeights& weights, const SaveOptions& options, std::vector<std::string>& changes);

// The same with the nodes of the file that the skeleton came from, placed by `fit`.
void attach_rig(GltfSource& source, const std::vector<PlacedInstance>& instances, const TriangleMesh& mesh, const SkeletonFile& skeleton,
                const Eigen::Affine3d& fit, const SkinWeights& weights, const SaveOptions& options, std::vector<std::string>& changes);

// Gives the meshes of `source` other weights for the joints that it has; nothing else changes, but that a skin gets the joints that it
// lacks, and that meshes which do not stand in their bind pose are rewritten, and bound, as they stand.
// Pre: the document was read as `instances`, and can_replace_weights holds: no joint is scaled to nothing.
void replace_weights(GltfSource& source, const std::vector<PlacedInstance>& instances, const TriangleMesh& mesh, const SkinWeights& weights,
                     const SaveOptions& options, std::vector<std::string>& changes);
bool can_replace_weights(const SourceDocument& source);

}  // namespace osteon::io::gltf
