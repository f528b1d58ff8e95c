// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "osteon/geometry/mirror_pairs.h"
#include "osteon/geometry/neighbourhoods.h"
#include "osteon/geometry/regions.h"
#include "osteon/geometry/voxel_grid.h"
#include "osteon/geometry/working_mesh.h"
#include "osteon/infer/rignet.h"
#include "osteon/pipelines/body_frame.h"
#include "osteon/pipelines/rignet_options.h"
#include "osteon/pipelines/stages.h"

namespace osteon::pipelines {

// What the stages know of a character, in its own frame, normalised (longest side 1).
struct Body {
  BodyFrame frame;
  geometry::WorkingMesh working;
  geometry::Neighbourhoods ring;  // of the working mesh
  nets::MeshArrays graph;
  geometry::Regions regions;  // of the surface, for the votes
  geometry::VoxelGrid voxels;
  std::optional<Plane> symmetry;
  std::optional<geometry::MirrorPairs> pairs;  // of working.clean.mesh
  std::size_t triangles = 0;                   // of the mesh that was given

  const std::vector<Vec3f>& positions() const { return working.mesh.positions.raw(); }
};

// Finds the character's own frame, reduces it to its working mesh, and measures what all networks read. Throws Error for a mesh without
// surface. Pre: validate(mesh) holds.
Body study(const TriangleMesh& mesh, const RignetOptions& options, Stages& stages);

// For the skin of what is finer than the working mesh: one of about so many vertices.
constexpr std::size_t kFineVertices = 4000;

// Replaces the working mesh of `body` by the fine one, without regions. `mesh`: the one that was studied. Pre: `options` ask for fewer
// vertices than kFineVertices.
void study_closer(Body& body, const TriangleMesh& mesh, geometry::WorkingMeshOptions options, Stages& stages);

// As it was before it was reduced, normalised.
TriangleMesh original_mesh(const Body& body);

}  // namespace osteon::pipelines
