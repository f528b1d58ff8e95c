// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/body.h"

#include "osteon/geometry/symmetry.h"

namespace osteon::pipelines {
namespace {

constexpr std::size_t kGeodesicNeighbours = 10;  // of a vertex, as in training (dataset::BatchOptions)

// The working mesh in the body's frame, and the plane of symmetry.
std::optional<Plane> stand(Body& body, const TriangleMesh& mesh, const RignetOptions& options, Stages& stages) {
  const auto look = [&] {
    body.working =
        stages.run("working mesh", [&] { return geometry::make_working_mesh(turned(mesh, body.frame.turn), options.working_mesh); });
    return stages.run("symmetry", [&] { return geometry::symmetry_plane(body.working.mesh); });
  };
  body.frame = stages.run("body frame", [&] { return body_frame(mesh, options.up); });
  std::optional<Plane> symmetry = look();
  for (int turns = 0; symmetry && turns < 2; ++turns) {
    const auto better = aligned(body.frame, *symmetry, mesh);
    if (!better) break;
    body.frame = *better;
    symmetry = look();
  }
  return symmetry;
}

// What all networks need to know of the working mesh.
geometry::GeodesicBalls survey(Body& body, Stages& stages) {
  const TriangleMesh& working = body.working.mesh;
  body.ring = geometry::one_ring(working);
  auto balls = stages.run("neighbourhoods", [&] { return geometry::geodesic_balls(working); });
  const auto geodesic = geometry::evenly(balls, kGeodesicNeighbours);
  body.graph = infer::single_mesh(body.positions(), {body.ring.offsets, body.ring.members}, {geodesic.offsets, geodesic.members});
  body.voxels = stages.run("voxels", [&] { return geometry::voxelize(working); });
  return balls;
}

}  // namespace

Body study(const TriangleMesh& mesh, const RignetOptions& options, Stages& stages) {
  Body body;
  body.triangles = mesh.faces.size();
  const std::optional<Plane> symmetry = stand(body, mesh, options, stages);
  if (options.symmetry == Symmetry::automatic && symmetry) {
    body.pairs = stages.run("mirror pairs", [&] { return geometry::mirror_pairs(original_mesh(body), *symmetry); });
    body.symmetry = body.pairs ? body.pairs->plane : *symmetry;
  }
  const geometry::GeodesicBalls balls = survey(body, stages);
  const TriangleMesh& working = body.working.mesh;
  body.regions =
      stages.run("regions", [&] { return geometry::regions(working, balls, nets::vote_regions, geometry::outermost_vertex(working)); });
  return body;
}

void study_closer(Body& body, const TriangleMesh& mesh, geometry::WorkingMeshOptions options, Stages& stages) {
  options.max_vertices += kFineVertices - options.target_vertices;
  options.target_vertices = kFineVertices;
  body.working = stages.run("working mesh", [&] { return geometry::make_working_mesh(turned(mesh, body.frame.turn), options); });
  survey(body, stages);
}

TriangleMesh original_mesh(const Body& body) {
  TriangleMesh out = body.working.clean.mesh;
  for (Vec3f& p : out.positions) p = body.working.normalization.apply(p);
  return out;
}

}  // namespace osteon::pipelines
