// SPDX-License-Identifier: Apache-2.0
#include "osteon/synth/polygonize.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <ranges>
#include <vector>

#include "osteon/base/parallel.h"

namespace osteon::synth {
namespace {

using Cell = Eigen::Array3i;

constexpr int kBlock = 8;            // empty space is skipped in blocks of 8^3 nodes
constexpr int kProjectionSteps = 3;  // Newton steps that set a vertex on the surface
constexpr std::uint32_t kNoVertex = std::numeric_limits<std::uint32_t>::max();

template <class Visit>
void for_each_cell(const Cell& low, const Cell& high, Visit&& visit) {
  for (int i = low.x(); i < high.x(); ++i)
    for (int j = low.y(); j < high.y(); ++j)
      for (int k = low.z(); k < high.z(); ++k) visit(Cell(i, j, k));
}

// Values of the function at the nodes of a grid; far nodes hold only the right sign. Node (i,j,k) is at origin + cell * (i,j,k).
class Samples {
 public:
  Samples(const LocalField& field, const Eigen::AlignedBox3f& box, float cell) : cell_(cell) {
    // Node columns at x = 0, +-cell, +-2 cell, ... make the grid its own mirror image.
    const Vec3f low = (box.min() / cell).array().floor() - 1.0f, high = (box.max() / cell).array().ceil() + 1.0f;
    const float half = std::max(-low.x(), high.x());
    first_ = Cell(-static_cast<int>(half), static_cast<int>(low.y()), static_cast<int>(low.z()));
    size_ = Cell(static_cast<int>(half), static_cast<int>(high.y()), static_cast<int>(high.z())) - first_ + 1;
    values_.assign(static_cast<std::size_t>(size_.prod()), 0.0f);
    const Cell blocks = (size_ + kBlock - 1) / kBlock;
    parallel_for(static_cast<std::size_t>(blocks.prod()), 8, [&](std::size_t begin, std::size_t end) {
      for (std::size_t b = begin; b < end; ++b) {
        const int i = static_cast<int>(b);
        fill_block(field, kBlock * Cell(i / (blocks.y() * blocks.z()), i / blocks.z() % blocks.y(), i % blocks.z()));
      }
    });
  }

  const Cell& size() const { return size_; }
  Vec3f position(const Cell& node) const { return cell_ * (node + first_).cast<float>().matrix(); }
  float operator[](const Cell& node) const { return values_[index(node)]; }
  std::size_t index(const Cell& node) const {
    return (static_cast<std::size_t>(node.x()) * static_cast<std::size_t>(size_.y()) + static_cast<std::size_t>(node.y())) *
               static_cast<std::size_t>(size_.z()) +
           static_cast<std::size_t>(node.z());
  }

 private:
  void fill_block(const LocalField& field, const Cell& low) {
    const Cell high = (low + kBlock).min(size_);
    const float radius = 0.5f * std::sqrt(3.0f) * cell_ * (kBlock + 2);  // beyond the neighbouring nodes
    const Vec3f centre = position(low) + Vec3f::Constant(0.5f * cell_ * (kBlock - 1));
    const Field here = field(centre, radius);
    const float middle = here(centre);
    const bool far = std::abs(middle) > radius;
    for_each_cell(low, high, [&](const Cell& node) { values_[index(node)] = far ? middle : here(position(node)); });
  }

  float cell_;
  Cell first_, size_;
  std::vector<float> values_;
};

constexpr std::array<std::array<int, 3>, 8> kCorners{
    {{0, 0, 0}, {0, 0, 1}, {0, 1, 0}, {0, 1, 1}, {1, 0, 0}, {1, 0, 1}, {1, 1, 0}, {1, 1, 1}}};
constexpr std::array<std::array<int, 2>, 12> kEdges{
    {{0, 1}, {2, 3}, {4, 5}, {6, 7}, {0, 2}, {1, 3}, {4, 6}, {5, 7}, {0, 4}, {1, 5}, {2, 6}, {3, 7}}};

Cell corner(const Cell& cell, int c) {
  const auto& [i, j, k] = kCorners[static_cast<std::size_t>(c)];
  return cell + Cell(i, j, k);
}

// The mean of the points where the surface cuts the cell's edges; empty where it cuts none.
std::optional<Vec3f> mean_crossing(const Samples& samples, const Cell& cell) {
  Vec3f sum = Vec3f::Zero();
  int cuts = 0;
  for (const auto& [a, b] : kEdges) {
    const Cell node_a = corner(cell, a), node_b = corner(cell, b);
    const float value_a = samples[node_a], value_b = samples[node_b];
    if ((value_a < 0.0f) == (value_b < 0.0f)) continue;
    const float t = value_a / (value_a - value_b);
    sum += samples.position(node_a) + t * (samples.position(node_b) - samples.position(node_a));
    ++cuts;
  }
  if (cuts == 0) return std::nullopt;
  return sum / static_cast<float>(cuts);
}

Vec3f gradient(const Field& distance, const Vec3f& p, float step) {
  Vec3f g;
  for (int axis = 0; axis < 3; ++axis) g[axis] = distance(p + step * Vec3f::Unit(axis)) - distance(p - step * Vec3f::Unit(axis));
  return g / (2.0f * step);
}

// Newton steps along the gradient, never further than half a cell in all.
Vec3f on_surface(const LocalField& field, const Vec3f& start, float cell) {
  const Field distance = field(start, cell);
  Vec3f p = start;
  for (int i = 0; i < kProjectionSteps; ++i) {
    const Vec3f g = gradient(distance, p, 0.05f * cell);
    if (!(g.squaredNorm() > 0.01f)) break;
    p -= distance(p) / g.squaredNorm() * g;
  }
  const Vec3f moved = p - start;
  return moved.norm() <= 0.5f * cell ? p : start;
}

// Two triangles a-b-c-d (counter-clockwise), split along the shorter diagonal.
void add_quad(TriangleMesh& mesh, VertexId a, VertexId b, VertexId c, VertexId d) {
  const auto length = [&](VertexId p, VertexId q) { return (mesh.positions[p] - mesh.positions[q]).squaredNorm(); };
  if (length(a, c) <= length(b, d)) {
    mesh.faces.push_back({a, b, c});
    mesh.faces.push_back({a, c, d});
  } else {
    mesh.faces.push_back({a, b, d});
    mesh.faces.push_back({b, c, d});
  }
}

// The four cells around the grid edge that leaves `node` along `axis`, joined by a quadrilateral if the surface cuts the edge.
void add_faces_at(const Samples& samples, const std::vector<std::uint32_t>& vertex_of, const Cell& node, int axis, TriangleMesh& mesh) {
  Cell next = node, u = Cell::Zero(), v = Cell::Zero();
  next[axis] += 1;
  u[(axis + 1) % 3] = 1;
  v[(axis + 2) % 3] = 1;
  const bool from_inside = samples[node] < 0.0f;
  if (from_inside == (samples[next] < 0.0f)) return;
  const auto vertex = [&](const Cell& cell) {
    assert(vertex_of[samples.index(cell)] != kNoVertex);
    return VertexId{vertex_of[samples.index(cell)]};
  };
  const VertexId a = vertex(node - u - v), b = vertex(node - v), c = vertex(node), d = vertex(node - u);  // counter-clockwise about +axis
  if (from_inside)
    add_quad(mesh, a, b, c, d);
  else
    add_quad(mesh, d, c, b, a);
}

}  // namespace

TriangleMesh polygonize(const LocalField& field, const Eigen::AlignedBox3f& box, float cell) {
  const Samples samples(field, box, cell);
  TriangleMesh mesh;
  std::vector<std::uint32_t> vertex_of(static_cast<std::size_t>(samples.size().prod()), kNoVertex);
  for_each_cell(Cell::Zero(), samples.size() - 1, [&](const Cell& at) {
    if (const auto crossing = mean_crossing(samples, at))
      vertex_of[samples.index(at)] = static_cast<std::uint32_t>(mesh.positions.push_back(*crossing));
  });
  parallel_for(mesh.positions.size(), 256, [&](std::size_t begin, std::size_t end) {
    for (VertexId v : ids<VertexId>(end) | std::views::drop(begin)) mesh.positions[v] = on_surface(field, mesh.positions[v], cell);
  });
  for_each_cell(Cell::Ones(), samples.size() - 1, [&](const Cell& node) {
    for (int axis = 0; axis < 3; ++axis) add_faces_at(samples, vertex_of, node, axis, mesh);
  });
  return mesh;
}

}  // namespace osteon::synth
