// SPDX-License-Identifier: Apache-2.0
#include "osteon/skin/bind.h"

#include "osteon/base/error.h"
#include "osteon/geometry/body_lattice.h"
#include "osteon/geometry/cleanup.h"
#include "osteon/geometry/neighbourhoods.h"
#include "osteon/skin/binding_bones.h"

namespace osteon::skin {
namespace {

struct Body {
  geometry::CleanMesh clean;
  float size;  // longest side
  std::vector<Bone> bones;
  BoneDistances distances;
};

Body measured(const TriangleMesh& mesh, const Skeleton& skeleton, int resolution) {
  Body out{geometry::clean(mesh), bounds(mesh).sizes().maxCoeff(), {}, {}};
  if (out.clean.mesh.faces.empty()) throw Error("the mesh has no face with an area: there is nothing to bind");
  geometry::BodyLattice body(out.clean.mesh, {.resolution = resolution});
  out.bones = binding_bones(skeleton, body);
  out.distances = bone_distances(body, out.bones);
  lengthen_past_ends(out.distances, out.clean.mesh.positions, out.bones, skeleton);
  return out;
}

WeightRows raw_weights(const Body& body, const BindOptions& options) {
  switch (options.method) {
    case Method::rigid:
      return nearest_weights(body.distances, body.bones);
    case Method::geovoxel:
      return falloff_weights(body.distances, body.bones, body.size, options.falloff);
  }
  return {};
}

}  // namespace

SkinWeights bind(const TriangleMesh& mesh, const Skeleton& skeleton, const BindOptions& options) {
  const Body body = measured(mesh, skeleton, options.resolution);
  WeightRows rows = raw_weights(body, options);
  if (options.islands == Islands::rigid) make_islands_rigid(rows, body.clean.mesh, options.island);
  if (options.method != Method::rigid) rows = smoothed(std::move(rows), geometry::one_ring(body.clean.mesh), options.smooth);
  prune(rows, options.prune_share, options.max_influences);
  return to_skin_weights(rows, body.clean.from_original);
}

}  // namespace osteon::skin
