// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/wholeness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numeric>
#include <utility>
#include <vector>

namespace osteon::geometry {
namespace {

constexpr float kInPlane = 0.002f;  // of the longest side
constexpr float kOfBorder = 0.5f, kOfSide = 0.4f;
constexpr double kOfArea = 0.4;

std::array<Eigen::Index, 2> horizontal(Eigen::Index up) { return {(up + 1) % 3, (up + 2) % 3}; }

using Edge = std::pair<VertexId, VertexId>;

// Of one face only.
std::vector<Edge> open_edges(const TriangleMesh& mesh) {
  std::vector<Edge> edges;
  for (const Triangle& face : mesh.faces)
    for (std::size_t k = 0; k < 3; ++k) edges.push_back(std::minmax({face[k], face[(k + 1) % 3]}));
  std::ranges::sort(edges);
  std::vector<Edge> open;
  for (std::size_t i = 0, next = 0; i < edges.size(); i = next) {
    while (next < edges.size() && edges[next] == edges[i]) ++next;
    if (next - i == 1) open.push_back(edges[i]);
  }
  return open;
}

struct Part {
  float low = 0, high = 0;
  double area = 0;
};

std::vector<Part> parts_along(Eigen::Index axis, const TriangleMesh& mesh, const Components& components) {
  std::vector<Eigen::AlignedBox3f> boxes(components.count);
  for (VertexId v : mesh.positions.ids()) boxes[components.of[v]].extend(mesh.positions[v]);
  std::vector<Part> parts;
  for (const auto& box : boxes) parts.push_back({box.min()[axis], box.max()[axis], 0});
  for (FaceId f : mesh.faces.ids()) parts[components.of[mesh.faces[f][0]]].area += static_cast<double>(area_vector(mesh, f).norm());
  std::ranges::sort(parts, {}, &Part::low);
  return parts;
}

}  // namespace

bool is_open_at_a_side(const TriangleMesh& mesh, Eigen::Index up) {
  const std::vector<Edge> border = open_edges(mesh);
  const Eigen::AlignedBox3f box = bounds(mesh);
  const auto length = [&](const Edge& e) { return (mesh.positions[e.first] - mesh.positions[e.second]).norm(); };
  const float all = std::transform_reduce(border.begin(), border.end(), 0.0f, std::plus{}, length);
  const float tolerance = kInPlane * box.sizes().maxCoeff();
  for (const Eigen::Index axis : horizontal(up)) {
    if (box.sizes()[axis] <= tolerance) continue;  // a flat sheet lies in its sides
    for (const float side : {box.min()[axis], box.max()[axis]}) {
      const auto lies_in = [&](VertexId v) { return std::abs(mesh.positions[v][axis] - side) <= tolerance; };
      float here = 0.0f;
      Eigen::AlignedBox3f cut;
      for (const Edge& e : border)
        if (lies_in(e.first) && lies_in(e.second)) {
          here += length(e);
          cut.extend(mesh.positions[e.first]).extend(mesh.positions[e.second]);
        }
      const auto spans = [&](Eigen::Index other) { return other == axis || cut.sizes()[other] > kOfSide * box.sizes()[other]; };
      if (here > kOfBorder * all && spans(0) && spans(1) && spans(2)) return true;
    }
  }
  return false;
}

bool stands_side_by_side(const TriangleMesh& mesh, Eigen::Index up) {
  const Components components = connected_components(mesh);
  for (const Eigen::Index axis : horizontal(up)) {
    const std::vector<Part> parts = parts_along(axis, mesh, components);
    const double all = std::transform_reduce(parts.begin(), parts.end(), 0.0, std::plus{}, [](const Part& p) { return p.area; });
    float end = parts.front().high;
    double before = 0;
    for (const Part& part : parts) {
      if (part.low > end && std::min(before, all - before) >= kOfArea * all) return true;
      end = std::max(end, part.high);
      before += part.area;
    }
  }
  return false;
}

}  // namespace osteon::geometry
