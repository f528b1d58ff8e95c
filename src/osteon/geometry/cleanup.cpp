// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/cleanup.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <numeric>
#include <ranges>

#include "osteon/base/parallel.h"
#include "osteon/geometry/buckets.h"
#include "osteon/geometry/bvh.h"
#include "osteon/geometry/union_find.h"

namespace osteon::geometry {
namespace {

using Site = std::uint32_t;  // rank of a position among all different positions, sorted by x, y, z

constexpr std::size_t kGrain = 1 << 14;
constexpr double kFlat = 1e-6;  // a face whose height is below this part of its longest side has no area: rounding of float coordinates

// A face by the sites of its corners, the smallest first, and the original vertices there.
struct SiteFace {
  std::array<Site, 3> sites;
  std::array<std::uint32_t, 3> vertices;

  bool reversed() const { return sites[1] > sites[2]; }
  std::pair<Site, Site> others() const { return {std::min(sites[1], sites[2]), std::max(sites[1], sites[2])}; }
};

// Bits that compare as the floats do; -0 and 0 are one.
std::uint32_t sortable(float x) {
  const auto bits = std::bit_cast<std::uint32_t>(x + 0.0f);
  return bits & 0x80000000u ? ~bits : bits | 0x80000000u;
}

// Sorts (key, index) pairs by key; equal keys keep their order. Radix sort, least significant digit first.
void radix_sort(std::vector<std::pair<std::uint32_t, std::uint32_t>>& items) {
  constexpr int kDigit = 11;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> other(items.size());
  for (int shift = 0; shift < 32; shift += kDigit) {
    const auto digit = [&](std::uint32_t key) { return key >> shift & ((1u << kDigit) - 1); };
    std::vector<std::uint32_t> starts((1u << kDigit) + 1, 0);
    for (const auto& item : items) ++starts[digit(item.first) + 1];
    if (std::find(starts.begin(), starts.end(), items.size()) != starts.end()) continue;  // all digits are equal
    std::partial_sum(starts.begin(), starts.end(), starts.begin());
    for (const auto& item : items) other[starts[digit(item.first)]++] = item;
    items.swap(other);
  }
}

struct Sites {
  std::vector<Site> of;             // per original vertex
  std::vector<Vec3f> positions;     // per site
  std::vector<std::uint32_t> uses;  // vertices at the site
};

// Vertices sorted by x, y, z: by x first, then the runs of equal x, which are short in most meshes.
std::vector<std::uint32_t> sorted_by_position(const std::vector<Vec3f>& p) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> order(p.size());  // x, vertex
  for (std::uint32_t v = 0; v < p.size(); ++v) order[v] = {sortable(p[v].x()), v};
  radix_sort(order);
  std::vector<std::pair<std::size_t, std::size_t>> runs;
  for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
    while (end < order.size() && order[end].first == order[begin].first) ++end;
    if (end - begin > 1) runs.emplace_back(begin, end);
  }
  const auto yz = [&](const auto& item) { return std::uint64_t{sortable(p[item.second].y())} << 32 | sortable(p[item.second].z()); };
  parallel_for(runs.size(), 256, [&](std::size_t first, std::size_t last) {
    for (std::size_t r = first; r < last; ++r)
      std::sort(order.begin() + static_cast<std::ptrdiff_t>(runs[r].first), order.begin() + static_cast<std::ptrdiff_t>(runs[r].second),
                [&](const auto& a, const auto& b) { return yz(a) < yz(b); });
  });
  std::vector<std::uint32_t> vertices(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) vertices[i] = order[i].second;
  return vertices;
}

Sites find_sites(const std::vector<Vec3f>& positions) {
  const std::vector<std::uint32_t> order = sorted_by_position(positions);
  Sites sites;
  sites.of.resize(positions.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    const Vec3f& p = positions[order[i]];
    if (i == 0 || p != positions[order[i - 1]]) {    // -0 and 0 compare equal
      sites.positions.push_back(p + Vec3f::Zero());  // -0 becomes 0
      sites.uses.push_back(0);
    }
    sites.of[order[i]] = static_cast<Site>(sites.positions.size() - 1);
    ++sites.uses.back();
  }
  return sites;
}

bool has_area(const SiteFace& face, const Sites& sites) {
  if (face.sites[0] == face.sites[1] || face.sites[1] == face.sites[2] || face.sites[2] == face.sites[0]) return false;
  const Eigen::Vector3d a = sites.positions[face.sites[0]].cast<double>();
  const Eigen::Vector3d ab = sites.positions[face.sites[1]].cast<double>() - a, ac = sites.positions[face.sites[2]].cast<double>() - a;
  const double longest2 = std::max({ab.squaredNorm(), ac.squaredNorm(), (ac - ab).squaredNorm()});
  return ab.cross(ac).norm() > kFlat * longest2;
}

// The faces with area, grouped by their first site and sorted by their other two; copies lie side by side, with reversed ones last.
Buckets<SiteFace> sorted_faces(const TriangleMesh& mesh, const Sites& sites) {
  std::vector<SiteFace> faces(mesh.faces.size());
  std::vector<std::uint8_t> keep(faces.size());
  parallel_for(faces.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t f = begin; f < end; ++f) {
      const Triangle& t = mesh.faces.raw()[f];
      const std::array<Site, 3> s = {sites.of[index(t[0])], sites.of[index(t[1])], sites.of[index(t[2])]};
      const auto first = static_cast<std::size_t>(std::min_element(s.begin(), s.end()) - s.begin());
      for (std::size_t k = 0; k < 3; ++k) {
        faces[f].sites[k] = s[(first + k) % 3];
        faces[f].vertices[k] = static_cast<std::uint32_t>(t[(first + k) % 3]);
      }
      keep[f] = has_area(faces[f], sites);
    }
  });
  auto sorted = bucketed<SiteFace>(sites.positions.size(), [&](auto put) {
    for (std::size_t f = 0; f < faces.size(); ++f)
      if (keep[f]) put(faces[f].sites[0], faces[f]);
  });
  parallel_for(sorted.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) {
      const auto group = sorted.of(s);
      std::sort(group.begin(), group.end(), [](const SiteFace& a, const SiteFace& b) {
        return std::tuple(a.others(), a.reversed()) < std::tuple(b.others(), b.reversed());
      });
    }
  });
  return sorted;
}

// Index buffers are split along seams: joins the vertices at both ends of edges that have one face each but lie at the same place.
// An edge that two faces share by index is closed: nothing is sewn to it, so that parts which merely touch stay apart.
void sew_seams(const Buckets<SiteFace>& faces, const Sites& sites, UnionFind& vertices) {
  struct Edge {
    Site high;
    std::uint32_t low_vertex, high_vertex;
    auto operator<=>(const Edge&) const = default;
  };
  auto edges = bucketed<Edge>(sites.positions.size(), [&](auto put) {
    for (const SiteFace& face : faces.items)
      for (std::size_t k = 0; k < 3; ++k) {
        std::size_t low = k, high = (k + 1) % 3;
        if (sites.uses[face.sites[low]] < 2 && sites.uses[face.sites[high]] < 2) continue;
        if (face.sites[low] > face.sites[high]) std::swap(low, high);
        put(face.sites[low], Edge{face.sites[high], face.vertices[low], face.vertices[high]});
      }
  });
  parallel_for(edges.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t s = begin; s < end; ++s) std::sort(edges.of(s).begin(), edges.of(s).end());
  });
  for (std::size_t s = 0; s < edges.size(); ++s) {
    const auto group = edges.of(s);
    const Edge* open = nullptr;  // the last open edge seen at this place
    for (std::size_t i = 0, next = 0; i < group.size(); i = next) {
      while (next < group.size() && group[next] == group[i]) ++next;
      if (next - i > 1) continue;
      if (open && open->high == group[i].high) {
        vertices.join(open->low_vertex, group[i].low_vertex);
        vertices.join(open->high_vertex, group[i].high_vertex);
      }
      open = &group[i];
    }
  }
}

void join_corners(const SiteFace& a, const SiteFace& b, UnionFind& vertices) {
  for (std::size_t k = 0; k < 3; ++k) {
    const auto at = static_cast<std::size_t>(std::find(b.sites.begin(), b.sites.end(), a.sites[k]) - b.sites.begin());
    vertices.join(a.vertices[k], b.vertices[at]);
  }
}

// Joins the vertices of faces that lie at the same place: with equal corners always, with reversed ones (a sheet modelled from both sides)
// within one component only, as the caps of two boxes that touch belong to either.
void join_copies(const Buckets<SiteFace>& faces, UnionFind& vertices) {
  std::vector<std::pair<const SiteFace*, const SiteFace*>> reversed;
  for (std::size_t s = 0; s < faces.size(); ++s) {
    const auto group = faces.of(s);
    for (std::size_t i = 1; i < group.size(); ++i) {
      if (group[i].others() != group[i - 1].others()) continue;
      if (group[i].reversed() == group[i - 1].reversed())
        join_corners(group[i - 1], group[i], vertices);
      else
        reversed.emplace_back(&group[i - 1], &group[i]);
    }
  }
  if (reversed.empty()) return;
  UnionFind components = vertices;
  for (const SiteFace& face : faces.items)
    for (std::size_t k = 1; k < 3; ++k) components.join(face.vertices[0], face.vertices[k]);
  for (const auto& [a, b] : reversed)
    if (components.find(a->vertices[0]) == components.find(b->vertices[0])) join_corners(*a, *b, vertices);
}

// Keeps the first of the faces that have the same joined vertices.
void drop_copies(Buckets<SiteFace>& faces, UnionFind& vertices) {
  std::uint32_t kept = 0;
  for (std::size_t s = 0; s < faces.size(); ++s) {
    const std::uint32_t first = kept;
    for (const SiteFace& face : faces.of(s)) {
      bool is_copy = false;
      for (std::uint32_t i = kept; i-- > first && faces.items[i].others() == face.others() && !is_copy;)
        is_copy = vertices.find(faces.items[i].vertices[0]) == vertices.find(face.vertices[0]);
      if (!is_copy) faces.items[kept++] = face;
    }
    faces.offsets[s] = first;
  }
  faces.offsets.back() = kept;
  faces.items.resize(kept);
}

void remove_copies(Buckets<SiteFace>& faces, UnionFind& vertices) {
  join_copies(faces, vertices);
  drop_copies(faces, vertices);
}

// Numbers the groups of joined vertices by site and, where several lie at one site, by the first face that they appear in: no two of them
// share a face, as copies are joined. So the numbers depend on the shape only.
PerVertex<Vec3f> number_vertices(const Buckets<SiteFace>& faces, const Sites& sites, UnionFind& groups,
                                 std::vector<std::uint32_t>& number) {
  constexpr std::uint32_t kNone = ~0u;
  std::vector<std::uint32_t> in_order;  // representatives by first face
  std::vector<bool> seen(number.size(), false);
  for (const SiteFace& face : faces.items)
    for (std::uint32_t v : face.vertices)
      if (const std::uint32_t group = groups.find(v); !seen[group]) {
        seen[group] = true;
        in_order.push_back(group);
      }
  const auto by_site = bucketed<std::uint32_t>(sites.positions.size(), [&](auto put) {
    for (std::uint32_t group : in_order) put(sites.of[group], group);
  });
  PerVertex<Vec3f> positions;
  positions.reserve(by_site.items.size());
  std::fill(number.begin(), number.end(), kNone);
  for (std::uint32_t group : by_site.items)
    number[group] = static_cast<std::uint32_t>(positions.push_back(sites.positions[sites.of[group]]));
  for (std::uint32_t v = 0; v < number.size(); ++v) number[v] = number[groups.find(v)];
  return positions;
}

PerFace<Triangle> numbered_faces(const Buckets<SiteFace>& faces, const std::vector<std::uint32_t>& number) {
  PerFace<Triangle> out;
  out.reserve(faces.items.size());
  for (const auto& [a, b, c] : faces.items | std::views::transform(&SiteFace::vertices))
    out.push_back({static_cast<VertexId>(number[a]), static_cast<VertexId>(number[b]), static_cast<VertexId>(number[c])});
  return out;
}

// Where the vertices that no face uses go: to a clean vertex at their place, or else to the nearest corner of the nearest face.
void place_unused(CleanMesh& clean, const TriangleMesh& original, const Sites& sites, std::vector<std::uint32_t>& number) {
  constexpr std::uint32_t kNone = ~0u;
  std::vector<std::uint32_t> at_site(sites.positions.size(), kNone);
  for (std::size_t v = 0; v < number.size(); ++v) at_site[sites.of[v]] = std::min(at_site[sites.of[v]], number[v]);
  std::optional<Bvh> bvh;
  for (std::size_t s = 0; s < at_site.size(); ++s) {
    if (at_site[s] != kNone) continue;
    if (!bvh) bvh.emplace(clean.mesh);
    const ClosestPoint nearest = bvh->closest_point(sites.positions[s]);
    Eigen::Index corner = 0;
    nearest.barycentric.maxCoeff(&corner);
    at_site[s] = static_cast<std::uint32_t>(clean.mesh.faces[nearest.face][static_cast<std::size_t>(corner)]);
  }
  clean.from_original.resize(original.positions.size());
  for (VertexId v : original.positions.ids())
    clean.from_original[v] = static_cast<VertexId>(number[index(v)] != kNone ? number[index(v)] : at_site[sites.of[index(v)]]);
}

std::vector<std::string> describe(std::size_t faces, std::size_t with_area, std::size_t kept, std::size_t unused) {
  std::vector<std::string> repairs;
  if (with_area < faces) repairs.push_back(fmt::format("{} of {} faces have no area and were left out", faces - with_area, faces));
  if (kept < with_area) repairs.push_back(fmt::format("{} faces are copies of others and were left out", with_area - kept));
  if (unused > 0) repairs.push_back(fmt::format("{} vertices belong to no face with area", unused));
  return repairs;
}

}  // namespace

CleanMesh clean(const TriangleMesh& mesh) {
  const Sites sites = find_sites(mesh.positions.raw());
  Buckets<SiteFace> faces = sorted_faces(mesh, sites);
  const std::size_t with_area = faces.items.size();
  CleanMesh out;
  if (faces.items.empty()) {
    out.mesh.positions = PerVertex<Vec3f>(sites.positions);
    for (Site s : sites.of) out.from_original.push_back(static_cast<VertexId>(s));
    out.repairs = describe(mesh.faces.size(), 0, 0, mesh.positions.size());
    return out;
  }
  UnionFind groups(mesh.positions.size());
  remove_copies(faces, groups);
  sew_seams(faces, sites, groups);
  remove_copies(faces, groups);                              // again: what is now one component may show both sides of a sheet
  std::vector<std::uint32_t> number(mesh.positions.size());  // original vertex -> clean vertex
  out.mesh.positions = number_vertices(faces, sites, groups, number);
  out.mesh.faces = numbered_faces(faces, number);
  const auto unused = static_cast<std::size_t>(std::count(number.begin(), number.end(), ~0u));
  place_unused(out, mesh, sites, number);
  out.repairs = describe(mesh.faces.size(), with_area, out.mesh.faces.size(), unused);
  return out;
}

}  // namespace osteon::geometry
