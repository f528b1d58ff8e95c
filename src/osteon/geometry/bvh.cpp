// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/bvh.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>
#include <numeric>

#include "osteon/base/parallel.h"

namespace osteon::geometry {
namespace {

using Box = Eigen::AlignedBox3f;

constexpr std::size_t kLeafSize = TriangleBlock::kSize;
constexpr int kBins = 16;
constexpr int kSplitByAreaDepth = 48;  // below it ranges are halved, so that the depth stays under 48 + 32
constexpr int kStack = 96;

float half_area(const Box& box) {
  const Vec3f s = box.sizes();
  return s.x() * s.y() + s.y() * s.z() + s.z() * s.x();
}

// A ray with what the tests of boxes and triangles need, computed once.
struct Ray {
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

  // Where the ray enters the box, if it does so before `limit`. A zero component of the direction makes infinities of the right sign, and
  // NaN where the origin lies in a face of the box: comparisons with NaN are false, so that such an axis does not limit the ray.
  std::optional<float> enters(const Vec3f& low, const Vec3f& high, float limit) const {
    float near = 0, far = limit;
    for (int k = 0; k < 3; ++k) {
      const float in = ((inverse[k] < 0 ? high[k] : low[k]) - origin[k]) * inverse[k];
      const float out = ((inverse[k] < 0 ? low[k] : high[k]) - origin[k]) * inverse[k] * 1.0000004f;  // upward rounding: Ize, JCGT 2013
      if (in > near) near = in;
      if (out < far) far = out;
    }
    return near <= far ? std::optional(near) : std::nullopt;
  }

  // Distances to the triangles, by the signs of the three edge functions in the plane across the ray (Woop et al. 2013); infinite where it
  // misses them. Products of the sheared corners are exact in double, so the edge functions of two faces agree on their common edge.
  std::array<float, TriangleBlock::kSize> meets(const TriangleBlock& block) const {
    constexpr std::size_t n = TriangleBlock::kSize;
    double ax[n], ay[n], az[n], bx[n], by[n], bz[n], cx[n], cy[n], cz[n];
    shear_corner(block.a, ax, ay, az);
    shear_corner(block.b, bx, by, bz);
    shear_corner(block.c, cx, cy, cz);
    std::array<float, n> out;
    for (std::size_t l = 0; l < n; ++l) {
      const double u = cx[l] * by[l] - cy[l] * bx[l];
      const double v = ax[l] * cy[l] - ay[l] * cx[l];
      const double w = bx[l] * ay[l] - by[l] * ax[l];
      const double sum = u + v + w;  // 0: without area, or seen edge-on
      const double least = std::min(std::min(u, v), w), most = std::max(std::max(u, v), w);
      const auto distance = static_cast<float>((u * az[l] + v * bz[l] + w * cz[l]) / sum);
      const bool is_hit = !(least < 0 && most > 0) && sum != 0 && distance >= 0;
      out[l] = is_hit ? distance : std::numeric_limits<float>::infinity();
    }
    return out;
  }

 private:
  // The points with the origin at 0 and the ray along z.
  void shear_corner(const TriangleBlock::Corner& corner, double* x, double* y, double* z) const {
    const float* in_x = corner[axis[0]].data();
    const float* in_y = corner[axis[1]].data();
    const float* in_z = corner[axis[2]].data();
    for (std::size_t l = 0; l < TriangleBlock::kSize; ++l) {
      const float along = in_z[l] - at[2];
      x[l] = static_cast<double>((in_x[l] - at[0]) - shear.x() * along);
      y[l] = static_cast<double>((in_y[l] - at[1]) - shear.y() * along);
      z[l] = static_cast<double>(shear.z() * along);
    }
  }
};

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

Vec3f corner(const TriangleBlock::Corner& all, std::size_t triangle) { return {all[0][triangle], all[1][triangle], all[2][triangle]}; }

float squared_distance(const Vec3f& p, const Vec3f& low, const Vec3f& high) { return (p - p.cwiseMax(low).cwiseMin(high)).squaredNorm(); }

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

// Splits ranges of `order` top-down. The upper levels are split one after another, the subtrees below them in parallel, each into its own
// list of nodes.
struct Bvh::Builder {
  std::vector<Box> boxes;
  std::vector<Vec3f> centres;
  std::vector<std::uint32_t> order;
  struct Subtree {
    std::size_t begin, end;
    int depth;
    std::vector<Node> nodes;
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

  std::vector<Node> build() {
    std::vector<Node> top;
    split_top(0, order.size(), 0, top);
    parallel_for(subtrees.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t s = begin; s < end; ++s) split(subtrees[s].begin, subtrees[s].end, subtrees[s].depth, subtrees[s].nodes);
    });
    std::vector<Node> nodes;
    nodes.reserve(order.size());
    append(top, 0, nodes);
    return nodes;
  }

  // In `top` a node with count > 0 stands for the subtree number `first`.
  void split_top(std::size_t begin, std::size_t end, int depth, std::vector<Node>& top) {
    const std::size_t self = top.size();
    top.push_back(Node{Vec3f::Zero(), Vec3f::Zero(), static_cast<std::uint32_t>(subtrees.size()), static_cast<std::uint32_t>(end - begin)});
    if (end - begin <= subtree_size) {
      subtrees.push_back({begin, end, depth, {}});
      return;
    }
    const Box box = bounds_of(begin, end);
    const std::size_t middle = partition(begin, end, depth);
    split_top(begin, middle, depth + 1, top);
    top[self] = Node{box.min(), box.max(), static_cast<std::uint32_t>(top.size()), 0};
    split_top(middle, end, depth + 1, top);
  }

  void split(std::size_t begin, std::size_t end, int depth, std::vector<Node>& nodes) {
    const std::size_t self = nodes.size();
    const Box box = bounds_of(begin, end);
    nodes.push_back(Node{box.min(), box.max(), static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end - begin)});
    if (end - begin <= kLeafSize) return;
    const std::size_t middle = partition(begin, end, depth);
    split(begin, middle, depth + 1, nodes);
    nodes[self].first = static_cast<std::uint32_t>(nodes.size());
    nodes[self].count = 0;
    split(middle, end, depth + 1, nodes);
  }

  void append(const std::vector<Node>& top, std::size_t node, std::vector<Node>& nodes) {
    const auto self = static_cast<std::uint32_t>(nodes.size());
    if (top[node].count > 0) {
      for (Node n : subtrees[top[node].first].nodes) {
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
    if (extent > 0 && depth < kSplitByAreaDepth) {
      const float scale = kBins / extent;
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
    return begin + (end - begin) / 2;  // all centres at one place
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
};

Bvh::Bvh(const TriangleMesh& mesh) {
  if (mesh.faces.empty()) return;
  Builder builder(mesh);
  nodes_ = builder.build();
  std::vector<Node*> leaves;
  for (Node& node : nodes_)
    if (node.count > 0) leaves.push_back(&node);
  blocks_.resize(leaves.size());
  parallel_for(leaves.size(), 1 << 12, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      Node& leaf = *leaves[i];
      for (std::uint32_t l = 0; l < TriangleBlock::kSize; ++l) {
        const auto face = static_cast<FaceId>(builder.order[leaf.first + std::min(l, leaf.count - 1)]);
        const auto [a, b, c] = mesh.faces[face];
        for (std::size_t axis = 0; axis < 3; ++axis) {
          blocks_[i].a[axis][l] = mesh.positions[a][static_cast<int>(axis)];
          blocks_[i].b[axis][l] = mesh.positions[b][static_cast<int>(axis)];
          blocks_[i].c[axis][l] = mesh.positions[c][static_cast<int>(axis)];
        }
        blocks_[i].face[l] = face;
      }
      leaf.first = static_cast<std::uint32_t>(i);
    }
  });
}

std::optional<RayHit> Bvh::first_hit(const Vec3f& origin, const Vec3f& direction, float max_distance) const {
  if (nodes_.empty()) return std::nullopt;
  assert(std::abs(direction.squaredNorm() - 1) < 1e-3f);
  const Ray ray(origin, direction);
  RayHit best{FaceId{~0u}, max_distance};
  std::array<std::pair<std::uint32_t, float>, kStack> stack;  // node, where the ray enters it
  std::size_t size = 0;
  const auto push = [&](std::uint32_t node) {
    if (const auto near = ray.enters(nodes_[node].low, nodes_[node].high, best.distance)) stack[size++] = {node, *near};
  };
  push(0);
  while (size > 0) {
    const auto [at, near] = stack[--size];
    if (near > best.distance) continue;
    const Node& node = nodes_[at];
    if (node.count > 0) {
      const TriangleBlock& block = blocks_[node.first];
      const auto distances = ray.meets(block);
      for (std::size_t l = 0; l < TriangleBlock::kSize; ++l)
        if (std::isfinite(distances[l]) && beats(distances[l], block.face[l], best.distance, best.face))
          best = {block.face[l], distances[l]};
      continue;
    }
    const std::size_t before = size;
    push(at + 1);
    push(node.first);
    if (size == before + 2 && stack[before].second < stack[before + 1].second)
      std::swap(stack[before], stack[before + 1]);  // the nearer one on top
  }
  return best.face == FaceId{~0u} ? std::nullopt : std::optional(best);
}

bool Bvh::blocked(const Segment& segment) const {
  const Vec3f along = segment.b - segment.a;
  const float length = along.norm();
  if (nodes_.empty() || length == 0) return false;
  const Ray ray(segment.a, along / length);
  std::array<std::uint32_t, kStack> stack;
  std::size_t size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const std::uint32_t at = stack[--size];
    const Node& node = nodes_[at];
    if (!ray.enters(node.low, node.high, length)) continue;
    if (node.count > 0) {
      if (std::ranges::min(ray.meets(blocks_[node.first])) <= length) return true;
      continue;
    }
    stack[size++] = node.first;
    stack[size++] = at + 1;
  }
  return false;
}

ClosestPoint Bvh::closest_point(const Vec3f& p) const {
  assert(!nodes_.empty());
  ClosestPoint best{FaceId{~0u}, Vec3f::Zero(), Vec3f::Zero(), 0};
  float best2 = std::numeric_limits<float>::infinity();
  std::array<std::pair<std::uint32_t, float>, kStack> stack;  // node, squared distance to its box
  std::size_t size = 0;
  stack[size++] = {0, 0};
  while (size > 0) {
    const auto [at, box2] = stack[--size];
    if (box2 > best2 * 1.00001f) continue;  // the margin covers the rounding of both distances
    const Node& node = nodes_[at];
    if (node.count > 0) {
      const TriangleBlock& block = blocks_[node.first];
      for (std::uint32_t l = 0; l < node.count; ++l) {
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
    const std::uint32_t left = at + 1, right = node.first;
    stack[size++] = {right, squared_distance(p, nodes_[right].low, nodes_[right].high)};
    stack[size++] = {left, squared_distance(p, nodes_[left].low, nodes_[left].high)};
    if (stack[size - 2].second < stack[size - 1].second) std::swap(stack[size - 2], stack[size - 1]);
  }
  best.distance = std::sqrt(best2);
  return best;
}

}  // namespace osteon::geometry
