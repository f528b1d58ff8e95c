// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "osteon/geometry/bvh.h"
#include "osteon/geometry/solid_lattice.h"
#include "osteon/geometry/surface_graph.h"
#include "osteon/mesh/triangle_mesh.h"

namespace osteon::geometry {

struct BodyLatticeOptions {
  int resolution = 256;             // of the lattice, along the longest side
  std::size_t most_nodes = 400000;  // inside, about: a body that fills its bounding box gets larger cells instead
  float bridge = 0.015f;            // parts that lie on one another hang together up to this distance, longest side 1
};

// A graph over the inside and the surface of a body, whose shortest paths stand for distances by way of the body. Nodes: those of the solid
// lattice, then the vertices of the mesh. Edges:
// - the lattice's steps, and those of surface_graph(mesh): so parts thinner than a cell (hair cards, wings, cloth) are connected too;
// - from a vertex to up to four nodes of the lattice beneath it that no face hides;
// - bridges between parts that lie on one another (cloth on a body): from a vertex to the corners of the nearest face of another part, with
// a
//   normal that agrees (cosine above 0.25). Parts that touch face to face, as hand and thigh do, are not bridged.
class BodyLattice {
 public:
  // Pre: validate(mesh) holds, mesh has faces; vertices at one position of one surface are one (geometry::clean).
  explicit BodyLattice(const TriangleMesh& mesh, const BodyLatticeOptions& options = {});

  const SolidLattice& solid() const { return solid_; }
  const Bvh& surface() const { return surface_; }
  const PerFace<Triangle>& faces() const { return faces_; }  // of the mesh
  std::size_t size() const { return solid_.nodes() + positions_.size(); }
  bool is_vertex(std::uint32_t node) const { return node >= solid_.nodes(); }
  std::uint32_t node(VertexId v) const { return static_cast<std::uint32_t>(solid_.nodes() + osteon::index(v)); }
  VertexId vertex(std::uint32_t node) const { return static_cast<VertexId>(node - solid_.nodes()); }
  const Vec3f& position(std::uint32_t node) const { return is_vertex(node) ? positions_[vertex(node)] : solid_.positions[node]; }
  // Edges that are no steps of the lattice.
  std::span<const SurfaceGraph::Edge> links(std::uint32_t node) const { return links_.of(node); }

  // Calls visit(to, length) for every edge of a node.
  template <class Visit>
  void visit_edges(std::uint32_t node, const Visit& visit) const {
    for (const auto& [to, length] : links(node)) visit(to, length);
    if (is_vertex(node)) return;
    const std::uint32_t* cell = &solid_.node_of[solid_.cell_of[node]];
    for (std::uint32_t left = solid_.steps[node]; left != 0; left &= left - 1) {
      const auto k = static_cast<std::size_t>(std::countr_zero(left));
      visit(cell[step_offsets_[k]], step_lengths_[k]);
    }
  }
  // The node that step k leads to; pre: the step is allowed.
  std::uint32_t step(std::uint32_t node, std::size_t k) const { return (&solid_.node_of[solid_.cell_of[node]])[step_offsets_[k]]; }

  // Which nodes hang together: each piece is named by its smallest node.
  std::vector<std::uint32_t> pieces() const;
  // Links every piece with a vertex but without any of `sources` (nodes) to the surface that is nearest to it of those that have one, at up
  // to 64 of its vertices. Pre: some source hangs together with a vertex.
  void join_to(std::span<const std::uint32_t> sources);

 private:
  void link_vertices_to_solid(const TriangleMesh& mesh, std::vector<Link>& links) const;
  void set_links(std::vector<Link> links);

  PerVertex<Vec3f> positions_;
  PerFace<Triangle> faces_;
  SolidLattice solid_;
  Bvh surface_;
  SurfaceGraph links_;  // over all nodes
  std::array<std::ptrdiff_t, 26> step_offsets_;
  std::array<float, 26> step_lengths_;
};

}  // namespace osteon::geometry
