// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/decimate.h"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>

#include "osteon/base/parallel.h"
#include "osteon/geometry/buckets.h"
#include "osteon/geometry/quadric.h"

namespace osteon::geometry {
namespace {

using Vec3d = Eigen::Vector3d;
using Face = std::array<std::uint32_t, 3>;

constexpr std::size_t kGrain = 1 << 12;
constexpr double kBorderWeight = 1.0;   // planes along open borders, per squared length of the edge
constexpr double kLeastTurn = 0.2;      // cosine between a face's normals before and after
constexpr double kLeastQuality = 0.05;  // twice the area by the squared longest side: 0.87 for an equilateral triangle
// Of a vertex that merges: the hub of a fan has as many edges, and each would go through all of them.
constexpr std::size_t kMostFaces = 1024;

// Rounds take the cheapest edges, so many per vertex (a mesh has three). Far from the target speed counts, near it the order of costs.
constexpr std::size_t kFar = 8, kVeryFar = 100;
constexpr double kShareFar = 0.5, kShareNear = 0.1;

struct Edge {
  std::uint32_t a, b;   // a < b
  std::uint32_t faces;  // how many have it
};

bool has(const Face& face, std::uint32_t v) { return face[0] == v || face[1] == v || face[2] == v; }

// How the chosen edges of a round are gone through. Neighbours in memory are neighbours in space: going by place saves most cache misses.
enum class Order { by_cost, by_place };

// The mesh while it shrinks. Between rounds all arrays hold what is alive and nothing else.
class Decimation {
 public:
  Decimation(const TriangleMesh& mesh, const DecimateOptions& options) : options_(options) {
    normalise(mesh);
    faces_.reserve(mesh.faces.size());
    for (const auto& [a, b, c] : mesh.faces)
      if (a != b && b != c && c != a)
        faces_.push_back({static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b), static_cast<std::uint32_t>(c)});
    origin_.resize(positions_.size());
    std::iota(origin_.begin(), origin_.end(), 0u);
    merged_into_ = origin_;
    find_rings();
    find_edges();
    start_quadrics();
  }

  std::size_t vertices() const { return positions_.size(); }

  // Tries the cheapest `candidates` edges and merges at most `most` of them. Returns how many were merged.
  std::size_t round(std::size_t candidates, Order order, std::size_t most) {
    const std::vector<std::uint32_t> edges = cheapest_edges(candidates, order);
    std::size_t merged = 0;
    touched_.assign(vertices(), false);
    for (std::size_t i = 0; i < edges.size() && merged < most; ++i) merged += try_merge(edges_[edges[i]]);
    if (merged > 0) {
      compact();
      find_rings();
      find_edges();
    }
    return merged;
  }

  std::size_t edges() const { return edges_.size(); }

  // Whether faces may be squeezed flat for now, though not turned around: very far from the target, or where the cheapest edges cannot be
  // merged otherwise. An even pattern of thin faces, one face cut finely, becomes less even by any merge and would stay as dense as it is;
  // later merges make the faces round.
  void let_squeeze(bool may) { may_squeeze_ = may; }
  void allow_folds() { may_fold_ = true; }
  bool may_fold() const { return may_fold_; }

  DecimatedMesh result() const {
    DecimatedMesh out;
    std::vector<std::uint32_t> place(merged_into_.size());
    for (std::uint32_t v = 0; v < vertices(); ++v) {
      place[origin_[v]] = v;
      out.mesh.positions.push_back((positions_[v] * size_ + centre_).cast<float>());
    }
    for (const auto& [a, b, c] : faces_) out.mesh.faces.push_back({VertexId{a}, VertexId{b}, VertexId{c}});
    out.from_input.resize(merged_into_.size());
    for (std::uint32_t v = 0; v < merged_into_.size(); ++v) {
      if (merged_into_[v] != v) place[v] = place[merged_into_[v]];  // merged into a smaller index, whose place is known
      out.from_input[VertexId{v}] = VertexId{place[v]};
    }
    return out;
  }

 private:
  // Unit size around the origin: constants and rounding then do not depend on the unit. Doubles give each float back exactly.
  void normalise(const TriangleMesh& mesh) {
    const auto box = bounds(mesh);
    centre_ = box.center().cast<double>();
    size_ = static_cast<double>(box.sizes().maxCoeff());
    if (!(size_ > 0)) size_ = 1;
    positions_.reserve(mesh.positions.size());
    for (const Vec3f& p : mesh.positions) positions_.push_back((p.cast<double>() - centre_) / size_);
  }

  void find_rings() {
    rings_ = bucketed<std::uint32_t>(vertices(), [&](auto put) {
      for (std::uint32_t f = 0; f < faces_.size(); ++f)
        for (std::uint32_t v : faces_[f]) put(v, f);
    });
  }

  void find_edges() {
    std::vector<std::vector<Edge>> parts((vertices() + kGrain - 1) / kGrain);
    parallel_for(vertices(), kGrain, [&](std::size_t begin, std::size_t end) {
      std::vector<Edge>& part = parts[begin / kGrain];
      std::vector<std::uint32_t> others;
      for (auto v = static_cast<std::uint32_t>(begin); v < end; ++v) {
        others.clear();
        for (std::uint32_t f : rings_.of(v))
          for (std::uint32_t other : faces_[f])
            if (other > v) others.push_back(other);
        std::sort(others.begin(), others.end());
        for (std::size_t i = 0, next = 0; i < others.size(); i = next) {
          while (next < others.size() && others[next] == others[i]) ++next;
          part.push_back({v, others[i], static_cast<std::uint32_t>(next - i)});
        }
      }
    });
    edges_.clear();
    for (const auto& part : parts) edges_.insert(edges_.end(), part.begin(), part.end());
  }

  Vec3d area_vector(const Face& f) const { return (positions_[f[1]] - positions_[f[0]]).cross(positions_[f[2]] - positions_[f[0]]); }

  void start_quadrics() {
    quadrics_.resize(vertices());
    parallel_for(vertices(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v)
        for (std::uint32_t f : rings_.of(v)) {
          const Vec3d n = area_vector(faces_[f]);
          const double length = n.norm(), weight = length / 6;  // a third of the face's area
          if (length > 0) quadrics_[v] += Quadric::plane(n / length, positions_[v], weight);
          quadrics_[v] += Quadric::point(positions_[v], std::max(options_.spread, 1e-6) * weight + 1e-18);
        }
    });
    for (const Edge& e : edges_)
      if (e.faces == 1) hold_border(e);
  }

  // A plane through an open edge, perpendicular to its face.
  void hold_border(const Edge& e) {
    const auto ring = rings_.of(e.a);
    const std::uint32_t f = *std::find_if(ring.begin(), ring.end(), [&](std::uint32_t g) { return has(faces_[g], e.b); });
    const Vec3d along = positions_[e.b] - positions_[e.a], normal = along.cross(area_vector(faces_[f]));
    if (!(normal.norm() > 0)) return;
    const Quadric q = Quadric::plane(normal.normalized(), positions_[e.a], kBorderWeight * along.squaredNorm());
    quadrics_[e.a] += q;
    quadrics_[e.b] += q;
  }

  // Where the merged vertex goes: the minimum of both quadrics, or the best of both ends and the middle where that lies far off.
  Vec3d merged_position(const Edge& e, const Quadric& q) const {
    const Vec3d &a = positions_[e.a], &b = positions_[e.b], middle = 0.5 * (a + b);
    const Vec3d best = q.minimum();
    if ((best - middle).squaredNorm() <= (b - a).squaredNorm()) return best;
    return std::min({middle, a, b}, [&](const Vec3d& x, const Vec3d& y) { return q(x) < q(y); });
  }

  // Indices into edges_; edges of equal cost count as sorted by index.
  std::vector<std::uint32_t> cheapest_edges(std::size_t count, Order order) const {
    std::vector<std::uint64_t> keys(edges_.size());
    parallel_for(keys.size(), kGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        const Quadric q = quadrics_[edges_[i].a] + quadrics_[edges_[i].b];
        const auto cost = static_cast<float>(q(merged_position(edges_[i], q)));  // >= 0: its bits compare as it does
        keys[i] = std::uint64_t{std::bit_cast<std::uint32_t>(cost)} << 32 | i;
      }
    });
    if (count < keys.size()) {
      std::nth_element(keys.begin(), keys.begin() + static_cast<std::ptrdiff_t>(count), keys.end());
      keys.resize(count);
    }
    if (order == Order::by_cost) std::sort(keys.begin(), keys.end());
    std::vector<std::uint32_t> edges(keys.size());
    for (std::size_t i = 0; i < keys.size(); ++i) edges[i] = static_cast<std::uint32_t>(keys[i]);
    if (order == Order::by_place) std::sort(edges.begin(), edges.end());
    return edges;
  }

  bool try_merge(const Edge& e) {
    if (touched_[e.a] || touched_[e.b]) return false;
    if (std::max(rings_.of(e.a).size(), rings_.of(e.b).size()) > kMostFaces) return false;
    if (tears(e)) return false;
    const Quadric q = quadrics_[e.a] + quadrics_[e.b];
    const Vec3d position = merged_position(e, q);
    if (!may_fold_ && (folds(e.a, e.b, position) || folds(e.b, e.a, position))) return false;
    merge(e, q, position);
    return true;
  }

  bool alive(std::uint32_t face) const { return faces_[face][0] != faces_[face][1]; }

  // The corners opposite the edge lose a face: each needs another one with a or b, or it would come off (the last face of a piece, an ear,
  // a hinge).
  bool tears(const Edge& e) const {
    const auto holds = [&](std::uint32_t corner, std::uint32_t f) {
      return alive(f) && has(faces_[f], corner) && !(has(faces_[f], e.a) && has(faces_[f], e.b));
    };
    for (std::uint32_t f : rings_.of(e.a)) {
      if (!alive(f) || !has(faces_[f], e.b)) continue;
      for (std::uint32_t corner : faces_[f]) {
        if (corner == e.a || corner == e.b) continue;
        const auto holds_it = [&](std::uint32_t g) { return holds(corner, g); };
        if (std::ranges::none_of(rings_.of(e.a), holds_it) && std::ranges::none_of(rings_.of(e.b), holds_it)) return true;
      }
    }
    return false;
  }

  // Whether moving v to `position` turns a face around or squeezes it flat without leave; faces with `other` vanish anyway.
  bool folds(std::uint32_t v, std::uint32_t other, const Vec3d& position) const {
    for (std::uint32_t f : rings_.of(v)) {
      if (!alive(f) || has(faces_[f], other)) continue;
      const Face& face = faces_[f];
      const std::size_t k = face[0] == v ? 0 : face[1] == v ? 1 : 2;
      const Vec3d &b = positions_[face[(k + 1) % 3]], &c = positions_[face[(k + 2) % 3]];
      const Vec3d before = (b - positions_[v]).cross(c - positions_[v]), after = (b - position).cross(c - position);
      const double length_before = before.norm(), length_after = after.norm();
      if (before.dot(after) < kLeastTurn * length_before * length_after) return true;
      if (may_squeeze_) continue;
      const double side_before = std::max({(b - positions_[v]).squaredNorm(), (c - positions_[v]).squaredNorm(), (c - b).squaredNorm()});
      const double side_after = std::max({(b - position).squaredNorm(), (c - position).squaredNorm(), (c - b).squaredNorm()});
      if (length_after < kLeastQuality * side_after && length_after * side_before <= length_before * side_after) return true;
    }
    return false;
  }

  void merge(const Edge& e, const Quadric& q, const Vec3d& position) {
    for (std::uint32_t f : rings_.of(e.b)) {
      if (!alive(f)) continue;
      if (has(faces_[f], e.a))
        faces_[f] = {0, 0, 0};
      else
        for (std::uint32_t& v : faces_[f])
          if (v == e.b) v = e.a;
    }
    positions_[e.a] = position;
    quadrics_[e.a] = q;
    merged_into_[origin_[e.b]] = origin_[e.a];
    touched_[e.a] = touched_[e.b] = true;
  }

  void compact() {
    std::vector<std::uint32_t> place(vertices());
    std::uint32_t kept = 0;
    for (std::uint32_t v = 0; v < place.size(); ++v) {
      if (merged_into_[origin_[v]] != origin_[v]) continue;
      place[v] = kept;
      positions_[kept] = positions_[v];
      quadrics_[kept] = quadrics_[v];
      origin_[kept] = origin_[v];
      ++kept;
    }
    positions_.resize(kept);
    quadrics_.resize(kept);
    origin_.resize(kept);
    std::erase_if(faces_, [](const Face& f) { return f[0] == f[1]; });
    for (Face& f : faces_)
      for (std::uint32_t& v : f) v = place[v];
  }

  DecimateOptions options_;
  Vec3d centre_;
  double size_ = 1;
  std::vector<Vec3d> positions_;
  std::vector<Quadric> quadrics_;
  std::vector<Face> faces_;                 // equal corners: dead
  std::vector<std::uint32_t> origin_;       // vertex -> input vertex
  std::vector<std::uint32_t> merged_into_;  // input vertex -> input vertex with a smaller index, or itself
  Buckets<std::uint32_t> rings_;            // faces of each vertex
  std::vector<Edge> edges_;
  std::vector<std::uint8_t> touched_;  // merged in this round
  bool may_squeeze_ = false, may_fold_ = false;
};

}  // namespace

DecimatedMesh decimate(const TriangleMesh& mesh, const DecimateOptions& options) {
  Decimation work(mesh, options);
  double share = 0;  // candidates per vertex
  std::size_t target = options.target_vertices;
  while (work.vertices() > target) {
    const bool far = work.vertices() > kFar * target;
    const double usual = far ? kShareFar : kShareNear;
    share = std::max(share, usual);
    const double wished = share * static_cast<double>(work.vertices());
    const auto candidates = static_cast<std::size_t>(std::min(wished, static_cast<double>(work.edges()))) + 1;
    work.let_squeeze(work.vertices() > kVeryFar * target || (far && share > usual));
    const std::size_t merged = work.round(candidates, far ? Order::by_place : Order::by_cost, work.vertices() - target);
    if (merged == 0 && candidates >= work.edges()) {  // every edge that is left holds the shape
      if (work.may_fold()) break;
      work.allow_folds();
      target = options.most_vertices;
    }
    share = merged * 10 < candidates ? 2 * share : usual;  // most of the cheapest cannot be merged: look further
  }
  return work.result();
}

}  // namespace osteon::geometry
