// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/bvh.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

#include "osteon/base/parallel.h"

namespace osteon::geometry {
namespace {

using Box = Eigen::AlignedBox3f;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::size_t kLeafSize = TriangleBlock::kSize;
constexpr int kBins = 16;
constexpr int kSplitByAreaDepth = 48;  // below it ranges are halved, so that the depth stays under 48 + 32
constexpr int kStack = 3 * (kSplitByAreaDepth + 32) + 4;

// Four at once: the compiler's own vectors, as it does not see them in loops.
using Floats = float __attribute__((vector_size(16)));
using Ints = std::int32_t __attribute__((vector_size(16)));
using Doubles = double __attribute__((vector_size(32)));

Floats all(float x) { return Floats{x, x, x, x}; }

Floats lanes(const std::array<float, 4>& numbers) {
  Floats out;
  std::memcpy(&out, numbers.data(), sizeof out);
  return out;
}

std::array<float, 4> numbers(Floats lanes) {
  std::array<float, 4> out;
  std::memcpy(out.data(), &lanes, sizeof lanes);
  return out;
}

float half_area(const Box& box) {
  const Vec3f s = box.sizes();
  return s.x() * s.y() + s.y() * s.z() + s.z() * s.x();
}

// Whether an answer at (value, face) is better than the best so far: nearer, or as near and of a smaller id.
template <class Value>
bool beats(Value value, FaceId face, Value best, FaceId best_face) {
  return value < best || (value == best && face < best_face);
}

Vec3f closest_on_segments(const Eigen::Vector3d& p, const std::array<Eigen::Vector3d, 3>& corners) {
  double best = std::numeric_limits<double>::infinity();
  Vec3f weights = Vec3f::UnitX();
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t next = (k + 1) % 3;
    const Eigen::Vector3d along = corners[next] - corners[k];
    const double length2 = along.squaredNorm();
    const double t = length2 > 0 ? std::clamp((p - corners[k]).dot(along) / length2, 0.0, 1.0) : 0.0;
    const double distance2 = (corners[k] + t * along - p).squaredNorm();
    if (distance2 >= best) continue;
    best = distance2;
    weights.setZero();
    weights[static_cast<int>(k)] = static_cast<float>(1 - t);
    weights[static_cast<int>(next)] = static_cast<float>(t);
  }
  return weights;
}

bool is_block(std::uint32_t child) { return child >> 31 != 0; }

Vec3f corner(const TriangleBlock::Corner& all, std::size_t triangle) { return {all[0][triangle], all[1][triangle], all[2][triangle]}; }

// Nodes still to be visited, the nearest last.
class Waiting {
 public:
  struct Item {
    std::uint32_t node;  // as in Node::child
    float key;
  };

  bool empty() const { return size_ == 0; }
  void push(std::uint32_t node, float key) { items_[size_++] = {node, key}; }
  Item pop() { return items_[--size_]; }
  // Puts the last few, those of one node, in order.
  void sort_from(std::size_t first) {
    for (std::size_t i = first + 1; i < size_; ++i)
      for (std::size_t j = i; j > first && items_[j - 1].key < items_[j].key; --j) std::swap(items_[j - 1], items_[j]);
  }
  std::size_t size() const { return size_; }

 private:
  std::array<Item, kStack> items_;
  std::size_t size_ = 0;
};

}  // namespace

Vec3f closest_barycentric(const Vec3f& p, const Vec3f& a, const Vec3f& b, const Vec3f& c) {
  const Eigen::Vector3d origin = a.cast<double>(), ab = b.cast<double>() - origin, ac = c.cast<double>() - origin;
  const Eigen::Vector3d ap = p.cast<double>() - origin;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return Vec3f::UnitX();
  const double abab = ab.squaredNorm(), abac = ab.dot(ac), acac = ac.squaredNorm();
  const double d3 = d1 - abab, d4 = d2 - abac;  // of bp
  if (d3 >= 0 && d4 <= d3) return Vec3f::UnitY();
  const double d5 = d1 - abac, d6 = d2 - acac;  // of cp
  if (d6 >= 0 && d5 <= d6) return Vec3f::UnitZ();
  const double va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
  if (va > 0 && vb > 0 && vc > 0) {
    const double sum = va + vb + vc;
    const Vec3f weights(0, static_cast<float>(vb / sum), static_cast<float>(vc / sum));
    return {1 - weights.y() - weights.z() > 0 ? 1 - weights.y() - weights.z() : 0.0f, weights.y(), weights.z()};
  }
  return closest_on_segments(ap, {Eigen::Vector3d::Zero(), ab, ac});
}

// A ray with what the tests of boxes and triangles need, computed once.
struct Bvh::Ray {
  Vec3f origin, inverse;
  std::array<std::size_t, 3> axis;  // the direction's largest component last
  std::array<float, 3> at;          // the origin along these
  Vec3f shear;

  Ray(const Vec3f& o, const Vec3f& direction) : origin(o), inverse(direction.cwiseInverse()) {
    int z = 0;
    direction.cwiseAbs().maxCoeff(&z);
    int x = (z + 1) % 3, y = (z + 2) % 3;
    if (direction[z] < 0) std::swap(x, y);  // keeps the winding
    axis = {static_cast<std::size_t>(x), static_cast<std::size_t>(y), static_cast<std::size_t>(z)};
    at = {o[x], o[y], o[z]};
    shear = Vec3f(direction[x] / direction[z], direction[y] / direction[z], 1 / direction[z]);
  }

  // Where the ray enters the boxes, infinite where it does not do so before `limit`. A zero component of the direction makes infinities of
  // the right sign, and NaN where the origin lies in a face of the box: comparisons with NaN are false, so that such an axis does not limit
  // the ray.
  std::array<float, 4> enters(const Node& node, float limit) const {
    Floats near = all(0.0f), far = all(limit);
    for (std::size_t k = 0; k < 3; ++k) {
      const float scale = inverse[static_cast<int>(k)], from = origin[static_cast<int>(k)];
      const Floats in = (lanes(scale < 0 ? node.high[k] : node.low[k]) - from) * scale;
      const Floats out = (lanes(scale < 0 ? node.low[k] : node.high[k]) - from) * scale * 1.0000004f;  // upward rounding: Ize, JCGT 2013
      near = in > near ? in : near;
      far = out < far ? out : far;
    }
    return numbers(near <= far ? near : all(kInfinity));
  }

  // Distances to the triangles, by the signs of the three edge functions in the plane across the ray (Woop et al. 2013); infinite where it
  // misses them. Products of the sheared corners are exact in double, so the edge functions of two faces agree on their common edge.
  std::array<float, 4> meets(const TriangleBlock& block) const {
    const Sheared a = sheared(block.a), b = sheared(block.b), c = sheared(block.c);
    const Doubles u = c.x * b.y - c.y * b.x;
    const Doubles v = a.x * c.y - a.y * c.x;
    const Doubles w = b.x * a.y - b.y * a.x;
    const Doubles sum = u + v + w;  // 0: without area, or seen edge-on
    const Doubles least_uv = v < u ? v : u, least = w < least_uv ? w : least_uv;
    const Doubles most_uv = u < v ? v : u, most = most_uv < w ? w : most_uv;
    const Floats distance = __builtin_convertvector((u * a.z + v * b.z + w * c.z) / sum, Floats);
    const auto is_hit = (least >= 0) | (most <= 0);
    const Floats met = __builtin_convertvector(is_hit & (sum != 0), Ints) & (distance >= 0) ? distance : all(kInfinity);
    return numbers(met);
  }

 private:
  struct Sheared {
    Doubles x, y, z;
  };

  // The corners with the origin at 0 and the ray along z.
  Sheared sheared(const TriangleBlock::Corner& corner) const {
    const Floats along = lanes(corner[axis[2]]) - at[2];
    return {__builtin_convertvector((lanes(corner[axis[0]]) - at[0]) - shear.x() * along, Doubles),
            __builtin_convertvector((lanes(corner[axis[1]]) - at[1]) - shear.y() * along, Doubles),
            __builtin_convertvector(shear.z() * along, Doubles)};
  }
};

// Splits ranges of `order` top-down. The upper levels are split one after another, the subtrees below them in parallel, each into its own
// list of nodes.
struct Bvh::Builder {
  // Of the tree of twos, depth first.
  struct Pair {
    Vec3f low, high;
    std::uint32_t first;  // leaf: its faces in `order`; inner node: its second child (the first child follows it)
    std::uint32_t count;  // faces of a leaf; 0 for an inner node

    float half_area() const { return geometry::half_area(Box(low, high)); }
  };
  std::vector<Box> boxes;
  std::vector<Vec3f> centres;
  std::vector<std::uint32_t> order;
  struct Subtree {
    std::size_t begin, end;
    int depth;
    std::vector<Pair> nodes;
  };
  std::vector<Subtree> subtrees;
  std::size_t subtree_size = 0;

  explicit Builder(const TriangleMesh& mesh) : boxes(mesh.faces.size()), centres(boxes.size()), order(boxes.size()) {
    parallel_for(boxes.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
      for (std::size_t f = begin; f < end; ++f) {
        for (VertexId v : mesh.faces.raw()[f]) boxes[f].extend(mesh.positions[v]);
        centres[f] = boxes[f].center();
      }
    });
    std::iota(order.begin(), order.end(), 0u);
    subtree_size = std::max<std::size_t>(1024, order.size() / 64);
  }

  std::vector<Pair> build() {
    std::vector<Pair> top;
    split_top(0, order.size(), 0, top);
    parallel_for(subtrees.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t s = begin; s < end; ++s) split(subtrees[s].begin, subtrees[s].end, subtrees[s].depth, subtrees[s].nodes);
    });
    std::vector<Pair> nodes;
    nodes.reserve(order.size());
    append(top, 0, nodes);
    return nodes;
  }

  // In `top` a node with count > 0 stands for the subtree number `first`.
  void split_top(std::size_t begin, std::size_t end, int depth, std::vector<Pair>& top) {
    const std::size_t self = top.size();
    top.push_back(Pair{Vec3f::Zero(), Vec3f::Zero(), static_cast<std::uint32_t>(subtrees.size()), static_cast<std::uint32_t>(end - begin)});
    if (end - begin <= subtree_size) {
      subtrees.push_back({begin, end, depth, {}});
      return;
    }
    const Box box = bounds_of(begin, end);
    const std::size_t middle = partition(begin, end, depth);
    split_top(begin, middle, depth + 1, top);
    top[self] = Pair{box.min(), box.max(), static_cast<std::uint32_t>(top.size()), 0};
    split_top(middle, end, depth + 1, top);
  }

  void split(std::size_t begin, std::size_t end, int depth, std::vector<Pair>& nodes) {
    const std::size_t self = nodes.size();
    const Box box = bounds_of(begin, end);
    nodes.push_back(Pair{box.min(), box.max(), static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end - begin)});
    if (end - begin <= kLeafSize) return;
    const std::size_t middle = partition(begin, end, depth);
    split(begin, middle, depth + 1, nodes);
    nodes[self].first = static_cast<std::uint32_t>(nodes.size());
    nodes[self].count = 0;
    split(middle, end, depth + 1, nodes);
  }

  void append(const std::vector<Pair>& top, std::size_t node, std::vector<Pair>& nodes) {
    const auto self = static_cast<std::uint32_t>(nodes.size());
    if (top[node].count > 0) {
      for (Pair n : subtrees[top[node].first].nodes) {
        if (n.count == 0) n.first += self;
        nodes.push_back(n);
      }
      return;
    }
    nodes.push_back(top[node]);
    append(top, node + 1, nodes);
    nodes[self].first = static_cast<std::uint32_t>(nodes.size());
    append(top, top[node].first, nodes);
  }

  Box bounds_of(std::size_t begin, std::size_t end) const {
    Box box;
    for (std::size_t i = begin; i < end; ++i) box.extend(boxes[order[i]]);
    return box;
  }

  // Reorders the range into two non-empty halves and returns where the second begins.
  std::size_t partition(std::size_t begin, std::size_t end, int depth) {
    Box box;
    for (std::size_t i = begin; i < end; ++i) box.extend(centres[order[i]]);
    int axis = 0;
    const float extent = box.sizes().maxCoeff(&axis);
    const float scale = kBins / extent;
    if (std::isfinite(scale) && depth < kSplitByAreaDepth) {
      const auto bin_of = [&](std::uint32_t f) {
        return std::min(kBins - 1, static_cast<int>((centres[f][axis] - box.min()[axis]) * scale));
      };
      if (const int cut = best_cut(begin, end, bin_of); cut > 0) {
        const auto middle =
            std::partition(order.begin() + static_cast<std::ptrdiff_t>(begin), order.begin() + static_cast<std::ptrdiff_t>(end),
                           [&](std::uint32_t f) { return bin_of(f) < cut; });
        return static_cast<std::size_t>(middle - order.begin());
      }
    }
    return begin + (end - begin) / 2;  // all centres at one place, or as good as that
  }

  // The bin where the right side starts at the least sum of (area × faces) of both sides; 0 when all faces fall into one bin.
  template <class BinOf>
  int best_cut(std::size_t begin, std::size_t end, const BinOf& bin_of) const {
    std::array<Box, kBins> bins;
    std::array<std::size_t, kBins> counts{};
    for (std::size_t i = begin; i < end; ++i) {
      const auto bin = static_cast<std::size_t>(bin_of(order[i]));
      bins[bin].extend(boxes[order[i]]);
      ++counts[bin];
    }
    std::array<float, kBins> right_cost{};
    Box right;
    std::size_t right_count = 0;
    for (std::size_t b = kBins; b-- > 1;) {
      right.extend(bins[b]);
      right_count += counts[b];
      right_cost[b] = right_count ? half_area(right) * static_cast<float>(right_count) : 0;
    }
    float best = std::numeric_limits<float>::infinity();
    int cut = 0;
    Box left;
    std::size_t left_count = 0;
    for (std::size_t b = 1; b < kBins; ++b) {
      left.extend(bins[b - 1]);
      left_count += counts[b - 1];
      if (left_count == 0 || left_count == end - begin) continue;
      const float cost = half_area(left) * static_cast<float>(left_count) + right_cost[b];
      if (cost < best || cut == 0) best = cost, cut = static_cast<int>(b);
    }
    return cut;
  }

  // The children of a node of four: those of a node of twos, and in place of the largest of them its own, while there is room.
  static std::vector<std::uint32_t> children_of(const std::vector<Pair>& pairs, std::uint32_t node) {
    std::vector<std::uint32_t> out{node};
    while (out.size() < 4) {
      const auto largest =
          std::ranges::max_element(out, {}, [&](std::uint32_t n) { return pairs[n].count > 0 ? -1.0f : pairs[n].half_area(); });
      if (pairs[*largest].count > 0) break;
      const std::uint32_t second = pairs[*largest].first;
      ++*largest;
      out.push_back(second);
    }
    return out;
  }
};

Bvh::Bvh(const TriangleMesh& mesh) {
  if (mesh.faces.empty()) return;
  Builder builder(mesh);
  const std::vector<Builder::Pair> pairs = builder.build();
  std::vector<const Builder::Pair*> leaves;
  std::vector<std::uint32_t> roots{0};  // of each node, in the tree of twos
  for (std::size_t n = 0; n < roots.size(); ++n) {
    Node node;
    for (auto& axis : node.low) axis.fill(kInfinity);
    for (auto& axis : node.high) axis.fill(-kInfinity);
    node.child.fill(0);
    std::size_t l = 0;
    for (const std::uint32_t child : Builder::children_of(pairs, roots[n])) {
      const Builder::Pair& pair = pairs[child];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        node.low[axis][l] = pair.low[static_cast<int>(axis)];
        node.high[axis][l] = pair.high[static_cast<int>(axis)];
      }
      if (pair.count > 0) {
        node.child[l] = ~static_cast<std::uint32_t>(leaves.size());
        leaves.push_back(&pair);
      } else {
        node.child[l] = static_cast<std::uint32_t>(roots.size());
        roots.push_back(child);
      }
      ++l;
    }
    nodes_.push_back(node);
  }
  blocks_.resize(leaves.size());
  parallel_for(leaves.size(), 1 << 12, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      TriangleBlock& block = blocks_[i];
      block.count = leaves[i]->count;
      for (std::uint32_t l = 0; l < TriangleBlock::kSize; ++l) {
        const auto face = static_cast<FaceId>(builder.order[leaves[i]->first + std::min(l, block.count - 1)]);
        const auto [a, b, c] = mesh.faces[face];
        for (std::size_t axis = 0; axis < 3; ++axis) {
          block.a[axis][l] = mesh.positions[a][static_cast<int>(axis)];
          block.b[axis][l] = mesh.positions[b][static_cast<int>(axis)];
          block.c[axis][l] = mesh.positions[c][static_cast<int>(axis)];
        }
        block.face[l] = face;
      }
    }
  });
}

std::optional<RayHit> Bvh::first_hit(const Vec3f& origin, const Vec3f& direction, float max_distance) const {
  if (nodes_.empty()) return std::nullopt;
  assert(std::abs(direction.squaredNorm() - 1) < 1e-3f);
  const Ray ray(origin, direction);
  RayHit best{FaceId{~0u}, max_distance};
  Waiting waiting;  // by where the ray enters
  waiting.push(0, 0.0f);
  while (!waiting.empty()) {
    const auto [at, near] = waiting.pop();
    if (near > best.distance) continue;
    if (is_block(at)) {
      const TriangleBlock& block = blocks_[~at];
      const auto distances = ray.meets(block);
      for (std::size_t l = 0; l < TriangleBlock::kSize; ++l)
        if (std::isfinite(distances[l]) && beats(distances[l], block.face[l], best.distance, best.face))
          best = {block.face[l], distances[l]};
      continue;
    }
    const Node& node = nodes_[at];
    const auto entries = ray.enters(node, best.distance);
    const std::size_t before = waiting.size();
    for (std::size_t l = 0; l < 4; ++l)
      if (entries[l] < kInfinity) waiting.push(node.child[l], entries[l]);
    waiting.sort_from(before);
  }
  return best.face == FaceId{~0u} ? std::nullopt : std::optional(best);
}

bool Bvh::blocked(const Segment& segment) const {
  const Vec3f along = segment.b - segment.a;
  const float length = along.norm();
  if (nodes_.empty() || length == 0) return false;
  const Ray ray(segment.a, along / length);
  Waiting waiting;
  waiting.push(0, 0.0f);
  while (!waiting.empty()) {
    const std::uint32_t at = waiting.pop().node;
    if (is_block(at)) {
      if (std::ranges::min(ray.meets(blocks_[~at])) <= length) return true;
      continue;
    }
    const Node& node = nodes_[at];
    const auto entries = ray.enters(node, length);
    for (std::size_t l = 0; l < 4; ++l)
      if (entries[l] < kInfinity) waiting.push(node.child[l], entries[l]);
  }
  return false;
}

ClosestPoint Bvh::closest_point(const Vec3f& p) const {
  assert(!nodes_.empty());
  ClosestPoint best{FaceId{~0u}, Vec3f::Zero(), Vec3f::Zero(), 0};
  float best2 = kInfinity;
  Waiting waiting;  // by the squared distance to the box, which is infinite where floats overflow: the smallest face is the answer then
  waiting.push(0, 0.0f);
  while (!waiting.empty()) {
    const auto [at, box2] = waiting.pop();
    if (box2 > best2 * 1.00001f) continue;  // the margin covers the rounding of both distances
    if (is_block(at)) {
      const TriangleBlock& block = blocks_[~at];
      for (std::uint32_t l = 0; l < block.count; ++l) {
        const Vec3f a = corner(block.a, l), b = corner(block.b, l), c = corner(block.c, l);
        const Vec3f weights = closest_barycentric(p, a, b, c);
        const Vec3f position = weights.x() * a + weights.y() * b + weights.z() * c;
        const float distance2 = (position - p).squaredNorm();
        if (!beats(distance2, block.face[l], best2, best.face)) continue;
        best2 = distance2;
        best = {block.face[l], weights, position, 0};
      }
      continue;
    }
    const Node& node = nodes_[at];
    std::array<float, 4> squared{};
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t l = 0; l < 4; ++l) {
        const float q = p[static_cast<int>(k)];
        const float beyond = std::max(std::max(node.low[k][l] - q, q - node.high[k][l]), 0.0f);
        squared[l] += beyond * beyond;
      }
    const std::size_t before = waiting.size();
    for (std::size_t l = 0; l < 4; ++l)
      if (node.child[l] != 0 && squared[l] <= best2 * 1.00001f) waiting.push(node.child[l], squared[l]);
    waiting.sort_from(before);
  }
  best.distance = std::sqrt(best2);
  return best;
}

}  // namespace osteon::geometry
