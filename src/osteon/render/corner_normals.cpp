// SPDX-License-Identifier: Apache-2.0
#include "osteon/render/corner_normals.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "osteon/base/parallel.h"

namespace osteon::render {
namespace {

constexpr std::size_t many = 256;  // faces around one place, beyond which a pairwise comparison costs more than a crease is worth

bool before(const Vec3f& a, const Vec3f& b) { return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3); }

// Number of the place of each vertex; vertices with equal coordinates share it.
std::vector<std::uint32_t> places(const PerVertex<Vec3f>& positions, std::size_t& count) {
  std::vector<std::uint32_t> order(positions.size()), place(positions.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return before(positions.raw()[a], positions.raw()[b]); });
  count = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    if (i == 0 || positions.raw()[order[i - 1]] != positions.raw()[order[i]]) ++count;
    place[order[i]] = static_cast<std::uint32_t>(count - 1);
  }
  return place;
}

struct FacesAround {
  std::vector<std::uint32_t> offsets, faces;
  std::span<const std::uint32_t> of(std::uint32_t place) const {
    return std::span(faces).subspan(offsets[place], offsets[place + 1] - offsets[place]);
  }
};

FacesAround faces_around(const PerFace<Triangle>& faces, const std::vector<std::uint32_t>& place, std::size_t count) {
  FacesAround around{std::vector<std::uint32_t>(count + 1), std::vector<std::uint32_t>(faces.size() * 3)};
  for (const Triangle& t : faces)
    for (const VertexId v : t) ++around.offsets[place[index(v)] + 1];
  std::partial_sum(around.offsets.begin(), around.offsets.end(), around.offsets.begin());
  std::vector<std::uint32_t> next(around.offsets.begin(), around.offsets.end() - 1);
  for (const FaceId f : faces.ids())
    for (const VertexId v : faces[f]) around.faces[next[place[index(v)]]++] = static_cast<std::uint32_t>(f);
  return around;
}

Vec3f unit(const Vec3f& v) {
  const float length = v.norm();
  return length > 0 ? Vec3f(v / length) : Vec3f(0, 0, 1);
}

}  // namespace

PerFace<std::array<Vec3f, 3>> corner_normals(const TriangleMesh& mesh, float crease) {
  std::size_t count = 0;
  const auto place = places(mesh.positions, count);
  const FacesAround around = faces_around(mesh.faces, place, count);
  PerFace<Vec3f> areas(mesh.faces.size());
  for (const FaceId f : mesh.faces.ids()) areas[f] = area_vector(mesh, f);

  PerFace<std::array<Vec3f, 3>> normals(mesh.faces.size());
  const float least_cosine = std::cos(crease);
  parallel_for(mesh.faces.size(), 4096, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Vec3f own = unit(areas.raw()[i]);
      for (std::size_t corner = 0; corner < 3; ++corner) {
        const auto neighbours = around.of(place[index(mesh.faces.raw()[i][corner])]);
        Vec3f sum = Vec3f::Zero();
        for (const std::uint32_t n : neighbours.first(std::min(neighbours.size(), many)))
          if (own.dot(areas.raw()[n]) >= least_cosine * areas.raw()[n].norm()) sum += areas.raw()[n];
        normals.raw()[i][corner] = sum.norm() > 0 ? unit(sum) : own;
      }
    }
  });
  return normals;
}

}  // namespace osteon::render
