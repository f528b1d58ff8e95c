// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/body_lattice.h"

#include <algorithm>
#include <cassert>
#include <limits>
#include <numeric>
#include <optional>
#include <tuple>

#include "osteon/base/parallel.h"
#include "osteon/geometry/orientation.h"
#include "osteon/geometry/union_find.h"

namespace osteon::geometry {
namespace {

using Eigen::Array3i;

constexpr std::size_t kVerticesPerTask = 256;
constexpr std::size_t kLinksInwards = 4;    // of a vertex
constexpr int kTriesInwards = 8;            // nodes beneath a vertex that are looked at
constexpr float kLeastAgreement = 0.25f;    // cosine between the normals of parts that lie on one another
constexpr float kLeastSteepness = 0.5f;     // cosine between a bridge and the normal
constexpr std::size_t kMostJoinLinks = 64;  // of a piece without source

std::uint32_t number(VertexId v) { return static_cast<std::uint32_t>(v); }

// Every range's links, in order.
template <class Find>
void append_in_parallel(std::size_t vertices, std::vector<Link>& links, const Find& find) {
  std::vector<std::vector<Link>> found((vertices + kVerticesPerTask - 1) / kVerticesPerTask);
  parallel_for(vertices, kVerticesPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) find(static_cast<VertexId>(v), found[begin / kVerticesPerTask]);
  });
  for (const auto& some : found) links.insert(links.end(), some.begin(), some.end());
}

// One component alone, to find the point of it that is nearest.
struct Part {
  Eigen::AlignedBox3f box;
  TriangleMesh mesh;  // positions of the component's vertices
  std::vector<VertexId> vertices;
  std::optional<Bvh> surface;
};

std::vector<Part> separated(const TriangleMesh& mesh, const Components& components) {
  std::vector<Part> parts(components.count);
  PerVertex<VertexId> local(mesh.positions.size());
  for (VertexId v : mesh.positions.ids()) {
    Part& part = parts[components.of[v]];
    local[v] = part.mesh.positions.push_back(mesh.positions[v]);
    part.vertices.push_back(v);
    part.box.extend(mesh.positions[v]);
  }
  for (const auto& [a, b, c] : mesh.faces) parts[components.of[a]].mesh.faces.push_back({local[a], local[b], local[c]});
  parallel_for(parts.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t p = begin; p < end; ++p)
      if (!parts[p].mesh.faces.empty()) parts[p].surface.emplace(parts[p].mesh);
  });
  return parts;
}

void add_bridges(const TriangleMesh& mesh, const Components& components, const PerVertex<Vec3f>& normals, float reach,
                 std::vector<Link>& links) {
  if (components.count < 2) return;
  const std::vector<Part> parts = separated(mesh, components);
  append_in_parallel(mesh.positions.size(), links, [&](VertexId v, std::vector<Link>& found) {
    const Vec3f& p = mesh.positions[v];
    for (std::size_t other = 0; other < parts.size(); ++other) {
      const Part& part = parts[other];
      if (other == components.of[v] || !part.surface || part.box.squaredExteriorDistance(p) > reach * reach) continue;
      const ClosestPoint nearest = part.surface->closest_point(p);
      if (nearest.distance > reach) continue;
      const Vec3f normal = area_vector(part.mesh, nearest.face).stableNormalized();
      if (normals[v].dot(normal) < kLeastAgreement) continue;
      const bool touches = nearest.distance < 0.1f * reach;
      if (!touches && std::abs((nearest.position - p).dot(normals[v])) < kLeastSteepness * nearest.distance) continue;
      for (VertexId corner : part.mesh.faces[nearest.face])
        found.push_back({number(v), number(part.vertices[index(corner)]), (p - part.mesh.positions[corner]).norm()});
    }
  });
}

}  // namespace

BodyLattice::BodyLattice(const TriangleMesh& mesh, const BodyLatticeOptions& options)
    : positions_(mesh.positions), faces_(mesh.faces), solid_(solid_lattice(mesh, options.resolution, options.most_nodes)), surface_(mesh) {
  const auto& steps = lattice_steps();
  for (std::size_t k = 0; k < steps.size(); ++k) {
    step_offsets_[k] = (steps[k].x() * solid_.size.y() + steps[k].y()) * solid_.size.z() + steps[k].z();
    step_lengths_[k] = solid_.cell * steps[k].matrix().cast<float>().norm();
  }
  const Components components = connected_components(mesh);
  const TriangleMesh outwards = faced_outwards(mesh, components);
  std::vector<Link> links;
  add_bridges(outwards, components, vertex_normals(outwards), options.bridge * bounds(mesh).sizes().maxCoeff(), links);
  const SurfaceGraph surface = with_links(surface_graph(mesh), links);
  links.clear();
  for (VertexId v : mesh.positions.ids())
    for (const auto& [to, length] : surface.of(index(v)))
      if (to > number(v)) links.push_back({node(v), node(VertexId{to}), length});
  link_vertices_to_solid(outwards, links);
  set_links(std::move(links));
}

void BodyLattice::link_vertices_to_solid(const TriangleMesh& mesh, std::vector<Link>& links) const {
  const PerVertex<Vec3f> normals = vertex_normals(mesh);
  append_in_parallel(mesh.positions.size(), links, [&](VertexId v, std::vector<Link>& found) {
    const Vec3f &p = mesh.positions[v], &normal = normals[v];
    const Array3i middle = solid_.cell_at(p - 0.5f * solid_.cell * normal);
    std::vector<std::pair<float, std::uint32_t>> near;  // beneath the vertex; the straighter and nearer the better
    for (const Array3i& step : lattice_steps())
      if (const std::uint32_t n = solid_.node_at(middle + step); n != SolidLattice::kNone) {
        const Vec3f way = solid_.positions[n] - p;
        if (way.dot(normal) < -0.2f * way.norm()) near.emplace_back(way.norm(), n);
      }
    if (const std::uint32_t n = solid_.node_at(middle); n != SolidLattice::kNone) {
      const Vec3f way = solid_.positions[n] - p;
      if (way.dot(normal) < 0.0f) near.emplace_back(way.norm(), n);
    }
    std::ranges::sort(near);
    std::size_t linked = 0;
    for (int k = 0; k < std::min(kTriesInwards, static_cast<int>(near.size())) && linked < kLinksInwards; ++k) {
      const auto [length, n] = near[static_cast<std::size_t>(k)];
      const Vec3f& to = solid_.positions[n];
      if (surface_.blocked({p + 0.02f * (to - p), to})) continue;
      found.push_back({node(v), n, length});
      ++linked;
    }
  });
}

void BodyLattice::set_links(std::vector<Link> links) { links_ = with_links({std::vector<std::uint32_t>(size() + 1, 0), {}}, links); }

std::vector<std::uint32_t> BodyLattice::pieces() const {
  UnionFind pieces(size());
  for (std::uint32_t n = 0; n < size(); ++n)
    visit_edges(n, [&](std::uint32_t to, float) {
      if (to < n) pieces.join(n, to);
    });
  return pieces.all();
}

void BodyLattice::join_to(std::span<const std::uint32_t> sources) {
  const std::vector<std::uint32_t> piece = pieces();
  std::vector<bool> has_source(size(), false);  // of pieces
  for (const std::uint32_t n : sources) has_source[piece[n]] = true;
  TriangleMesh reached{positions_, {}};
  for (const Triangle& face : faces_)
    if (has_source[piece[node(face[0])]]) reached.faces.push_back(face);
  std::vector<std::vector<VertexId>> others(size());  // vertices of pieces without source
  std::size_t lonely = 0;
  for (VertexId v : positions_.ids())
    if (!has_source[piece[node(v)]]) {
      others[piece[node(v)]].push_back(v);
      ++lonely;
    }
  if (lonely == 0 || reached.faces.empty()) return;
  const Bvh surface(reached);
  std::vector<Link> links;
  for (const std::vector<VertexId>& vertices : others) {
    const std::size_t stride = (vertices.size() + kMostJoinLinks - 1) / kMostJoinLinks;
    for (std::size_t i = 0; i < vertices.size(); i += stride) {
      const ClosestPoint nearest = surface.closest_point(positions_[vertices[i]]);
      for (VertexId corner : reached.faces[nearest.face])
        links.push_back({node(vertices[i]), node(corner), nearest.distance + (nearest.position - positions_[corner]).norm()});
    }
  }
  links_ = with_links(links_, links);
}

}  // namespace osteon::geometry
