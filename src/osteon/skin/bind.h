// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "osteon/mesh/triangle_mesh.h"
#include "osteon/rig/skeleton.h"
#include "osteon/rig/skin_weights.h"
#include "osteon/skin/islands.h"
#include "osteon/skin/weight_rows.h"

// Skin weights for any mesh and any skeleton, by geometry alone.
namespace osteon::skin {

enum class Method {
  rigid,     // the nearest bone by way of the body
  geovoxel,  // geodesic voxel binding: Dionne, de Lasa 2013
};

enum class Islands {
  rigid,   // small parts follow one joint each
  deform,  // they bend like everything else
};

struct BindOptions {
  Method method = Method::geovoxel;
  int resolution = 256;  // of the lattice, along the longest side
  FalloffOptions falloff;
  int smooth = 1;                  // rounds
  float prune_share = 0.05f;       // weights below this share of a vertex's largest go
  std::size_t max_influences = 4;  // per vertex
  Islands islands = Islands::rigid;
  IslandOptions island;
};

// Weights for every vertex of `mesh`, whatever it is like: open, non-manifold, in pieces, with faces that look inwards. The same for any
// number of threads and any order of vertices and faces. Throws Error for a mesh without any face that has an area. Pre: validate(mesh) and
// validate(skeleton) hold, in one space.
SkinWeights bind(const TriangleMesh& mesh, const Skeleton& skeleton, const BindOptions& options = {});

}  // namespace osteon::skin
