// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/working_mesh.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

#include "osteon/base/error.h"
#include "osteon/base/parallel.h"
#include "osteon/geometry/buckets.h"
#include "osteon/geometry/bvh.h"
#include "osteon/geometry/decimate.h"
#include "osteon/geometry/orientation.h"
#include "osteon/geometry/subdivide.h"

namespace osteon::geometry {
namespace {

constexpr std::size_t kVerticesPerPiece = 4;  // what the least that can be left of a closed piece takes
constexpr std::size_t kLargestRing = 512;     // faces of a vertex that are looked at one by one
constexpr float kLongestEdge = 3;             // of the mean spacing of the working mesh's vertices; longer edges are split first

TriangleMesh normalised(TriangleMesh mesh, const Normalization& normalization) {
  for (Vec3f& p : mesh.positions) p = normalization.apply(p);
  return mesh;
}

// Whether each component is among the `most` with the largest areas.
std::vector<bool> largest_components(const TriangleMesh& mesh, const Components& components, std::size_t most) {
  std::vector<double> areas(components.count, 0);
  for (FaceId f : mesh.faces.ids()) areas[components.of[mesh.faces[f][0]]] += static_cast<double>(area_vector(mesh, f).norm());
  std::vector<std::uint32_t> order(components.count);
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return areas[a] > areas[b]; });
  std::vector<bool> largest(components.count, false);
  for (std::size_t i = 0; i < std::min(most, order.size()); ++i) largest[order[i]] = true;
  return largest;
}

// Leaves out all but the `most` largest pieces, fills in where the clean vertices are now, and returns how many pieces there are.
std::size_t keep_largest_pieces(WorkingMesh& working, std::size_t most) {
  const Components components = connected_components(working.mesh);
  working.from_clean = PerVertex<std::optional<VertexId>>(working.mesh.positions.size());
  for (VertexId v : working.from_clean.ids()) working.from_clean[v] = v;
  if (components.count <= most) return components.count;
  const std::vector<bool> stays = largest_components(working.mesh, components, most);
  TriangleMesh kept;
  for (VertexId v : working.mesh.positions.ids())
    working.from_clean[v] = stays[components.of[v]] ? std::optional(kept.positions.push_back(working.mesh.positions[v])) : std::nullopt;
  for (const auto& [a, b, c] : working.mesh.faces)
    if (stays[components.of[a]]) kept.faces.push_back({*working.from_clean[a], *working.from_clean[b], *working.from_clean[c]});
  working.mesh = std::move(kept);
  return most;
}

// Even meshes: a body of a few long triangles under a finely modelled head gets vertices before the head loses its own.
TriangleMesh split_long_edges(TriangleMesh mesh, std::size_t target) {
  const auto spacing = static_cast<float>(std::sqrt(surface_area(mesh) / static_cast<double>(target)));
  const std::size_t most = mesh.positions.size() + target;
  return subdivide(std::move(mesh), {.most_vertices = most, .longest_edge = kLongestEdge * spacing});
}

// Finds points of the working mesh by walking over it.
class Surface {
 public:
  explicit Surface(const TriangleMesh& mesh) : mesh_(mesh), bvh_(mesh), normals_(mesh.faces.size()) {
    for (FaceId f : mesh.faces.ids()) normals_[f] = area_vector(mesh, f);
    rings_ = bucketed<FaceId>(mesh.positions.size(), [&](auto put) {
      for (FaceId f : mesh.faces.ids())
        for (VertexId v : mesh.faces[f]) put(index(v), f);
    });
  }

  SurfacePoint nearest(const Vec3f& p) const {
    const ClosestPoint closest = bvh_.closest_point(p);
    return surface_point(closest.face, closest.barycentric);
  }

  // The nearest point in the faces around `start`, then around the face found, until that brings nothing more. Hubs of fans are not walked
  // around: that would be all faces for each vertex.
  SurfacePoint walk(const Vec3f& p, const Vec3f& normal, VertexId start) const {
    Found best;
    look_around(p, normal, start, best);
    if (!best.face) return nearest(p);
    for (std::optional<FaceId> from; from != best.face;) {
      from = best.face;
      for (VertexId corner : mesh_.faces[*from]) look_around(p, normal, corner, best);
    }
    return surface_point(*best.face, best.weights);
  }

 private:
  struct Found {
    float cost = std::numeric_limits<float>::infinity();
    std::optional<FaceId> face;
    Vec3f weights = Vec3f::Zero();
  };

  SurfacePoint surface_point(FaceId face, const Vec3f& weights) const {
    return {mesh_.faces[face], {weights.x(), weights.y(), weights.z()}};
  }

  // Faces that look the other way count as twice as far: on thin parts (ears, fins, blades) each side then finds its own.
  void look_around(const Vec3f& p, const Vec3f& normal, VertexId v, Found& best) const {
    if (rings_.of(index(v)).size() > kLargestRing) return;
    for (FaceId f : rings_.of(index(v))) {
      const auto [a, b, c] = mesh_.faces[f];
      const Vec3f weights = closest_barycentric(p, mesh_.positions[a], mesh_.positions[b], mesh_.positions[c]);
      const Vec3f at = weights.x() * mesh_.positions[a] + weights.y() * mesh_.positions[b] + weights.z() * mesh_.positions[c];
      const float cost = (at - p).squaredNorm() * (normals_[f].dot(normal) < 0 ? 4.0f : 1.0f);
      if (cost < best.cost || (cost == best.cost && f < best.face)) best = {cost, f, weights};
    }
  }

  const TriangleMesh& mesh_;
  Bvh bvh_;
  PerFace<Vec3f> normals_;  // twice the area
  Buckets<FaceId> rings_;
};

}  // namespace

Normalization normalization_of(const TriangleMesh& mesh) {
  const auto box = bounds(mesh);
  const float side = box.sizes().maxCoeff();
  if (!(side > 0) || !std::isfinite(1 / side) || !std::isfinite(side)) throw Error("the mesh is {} in size; expected some extent", side);
  return {1 / side, Vec3f(box.center().x(), box.min().y(), box.center().z())};
}

WorkingMesh make_working_mesh(const TriangleMesh& original, const WorkingMeshOptions& options) {
  assert(options.min_vertices <= options.target_vertices && options.target_vertices <= options.max_vertices);
  WorkingMesh out;
  out.clean = clean(original);
  if (out.clean.mesh.faces.empty()) throw Error("the mesh has {} faces, but none with area", original.faces.size());
  if (const std::size_t turned = turn_against_neighbours(out.clean.mesh))
    out.clean.repairs.push_back(
        fmt::format("{} of {} faces looked the other way than the faces beside them and were turned", turned, out.clean.mesh.faces.size()));
  if (const std::size_t turned = turn_inside_out(out.clean.mesh))
    out.clean.repairs.push_back(fmt::format("{} of {} faces were inside out and were turned", turned, out.clean.mesh.faces.size()));
  out.normalization = normalization_of(out.clean.mesh);
  out.mesh = normalised(out.clean.mesh, out.normalization);

  const std::size_t most_pieces = 1 + (options.max_vertices - options.target_vertices) / kVerticesPerPiece;
  const std::size_t pieces = keep_largest_pieces(out, most_pieces);
  const std::size_t target = options.target_vertices + kVerticesPerPiece * (pieces - 1);
  out.mesh = split_long_edges(std::move(out.mesh), target);
  if (out.mesh.positions.size() > target) {
    DecimatedMesh reduced = decimate(out.mesh, {.target_vertices = target, .most_vertices = options.max_vertices});
    out.mesh = std::move(reduced.mesh);
    for (auto& v : out.from_clean)
      if (v) v = reduced.from_input[*v];
  } else {
    out.mesh = subdivide(std::move(out.mesh), {.most_vertices = options.min_vertices});
  }
  return out;
}

PerVertex<SurfacePoint> carry_back(const WorkingMesh& working) {
  const TriangleMesh& clean = working.clean.mesh;
  const PerVertex<Vec3f> normals = vertex_normals(clean);
  const Surface surface(working.mesh);
  PerVertex<SurfacePoint> of_clean(clean.positions.size());
  parallel_for(clean.positions.size(), 1024, [&](std::size_t begin, std::size_t end) {
    for (VertexId v : ids<VertexId>(end) | std::views::drop(begin)) {
      const Vec3f p = working.normalization.apply(clean.positions[v]);
      of_clean[v] = working.from_clean[v] ? surface.walk(p, normals[v], *working.from_clean[v]) : surface.nearest(p);
    }
  });
  PerVertex<SurfacePoint> out;
  out.reserve(working.clean.from_original.size());
  for (VertexId v : working.clean.from_original) out.push_back(of_clean[v]);
  return out;
}

}  // namespace osteon::geometry
