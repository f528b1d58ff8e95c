// SPDX-License-Identifier: Apache-2.0
#include "osteon/skin/bone_distances.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "osteon/base/parallel.h"

namespace osteon::skin {
namespace {

using geometry::BodyLattice;
using geometry::SolidLattice;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::size_t kVerticesPerTask = 1024;
constexpr float kPastEnd = 2.0f, kBeforeStart = 0.5f;  // see lengthen_past_ends
constexpr int kMostOutsideSamples = 64;                // of a bone, where it is outside the body
constexpr float kMostSteps = 131072.0f;                // of half a cell along a bone: one to a joint astray gets longer ones

Vec3f nearest_on(const Segment& s, const Vec3f& p) {
  const Vec3f d = s.b - s.a;
  const float squared = d.squaredNorm();
  return squared > 0.0f ? Vec3f(s.a + std::clamp((p - s.a).dot(d) / squared, 0.0f, 1.0f) * d) : s.a;
}

float straight_distance(const Segment& s, const Vec3f& p) { return (p - nearest_on(s, p)).norm(); }

std::vector<Segment> segments_of(std::span<const Bone> bones) {
  std::vector<Segment> out;
  for (const Bone& b : bones) out.push_back(b.segment);
  return out;
}

struct Source {
  std::uint32_t node, bone;
  float distance;
};

// Where the ways from a bone start: at the nodes that it passes, in their straight distance; where it passes none, at the faces next to it.
std::vector<Source> sources_of(std::uint32_t bone, const Segment& segment, const BodyLattice& body, const PerFace<Triangle>* faces) {
  std::vector<Source> out;
  const SolidLattice& solid = body.solid();
  const float length = (segment.b - segment.a).norm();
  const auto point = [&](int i, int steps) -> Vec3f {
    const float t = steps > 0 ? static_cast<float>(i) / static_cast<float>(steps) : 0.0f;
    return (1.0f - t) * segment.a + t * segment.b;
  };
  const int steps = static_cast<int>(std::min(std::ceil(2.0f * length / solid.cell), kMostSteps));
  for (int i = 0; i <= steps; ++i)
    if (const std::uint32_t n = solid.node_at(solid.cell_at(point(i, steps))); n != SolidLattice::kNone)
      if (out.empty() || out.back().node != n) out.push_back({n, bone, straight_distance(segment, solid.positions[n])});
  if (!out.empty() || !faces) return out;
  const int samples = std::min(steps, kMostOutsideSamples);
  for (int i = 0; i <= samples; ++i) {
    const geometry::ClosestPoint nearest = body.surface().closest_point(point(i, samples));
    for (VertexId corner : (*faces)[nearest.face])
      out.push_back({body.node(corner), bone, nearest.distance + (nearest.position - body.position(body.node(corner))).norm()});
  }
  return out;
}

// Shortest ways from bones. Each node knows its bone, how far that is and whether it sees it.
class Ways {
 public:
  Ways(const BodyLattice& body, std::span<const Segment> bones)
      : body_(body),
        bones_(bones),
        distances_(body.size(), kInfinity),
        bone_(body.size(), 0),
        sees_(body.size(), false),
        width_(body.solid().cell) {}

  // `is_near(node, distance)`: whether to go on from there.
  template <class IsNear>
  void run(std::span<const Source> sources, const IsNear& is_near) {
    for (const Source& s : sources)
      if (put(s.node, s.distance, s.bone)) sees_[s.node] = !body_.is_vertex(s.node);
    for (auto& [number, bucket] : buckets_)
      while (!bucket.empty()) {  // what is put meanwhile goes into this bucket or later ones
        const auto [node, distance] = bucket.back();
        bucket.pop_back();
        if (distance > distances_[node] || !is_near(node, distance)) continue;
        look_straight(node);
        current_ = number;
        const float here = distances_[node];
        body_.visit_edges(node, [&](std::uint32_t to, float length) {
          if (here + length < distances_[to] && put(to, here + length, bone_[node])) sees_[to] = false;
        });
      }
  }

  float distance(std::uint32_t node) const { return distances_[node]; }
  std::uint32_t bone(std::uint32_t node) const { return bone_[node]; }

 private:
  bool put(std::uint32_t node, float distance, std::uint32_t bone) {
    if (!(distance < distances_[node])) return false;
    distances_[node] = distance;
    bone_[node] = bone;
    buckets_[std::max(current_, static_cast<std::uint64_t>(distance / width_))].push_back({node, distance});
    return true;
  }

  // Gives the node the straight distance to its bone if the next node on the straight way sees the bone.
  void look_straight(std::uint32_t node) {
    if (sees_[node]) return;
    const Segment& bone = bones_[bone_[node]];
    const Vec3f& p = body_.position(node);
    const Vec3f way = nearest_on(bone, p) - p;
    if (body_.is_vertex(node)) {
      for (const auto& [to, length] : body_.links(node))
        if (!body_.is_vertex(to) && sees_[to] && bone_[to] == bone_[node]) {
          distances_[node] = std::min(distances_[node], way.norm());
          return;
        }
      return;
    }
    const float largest = way.cwiseAbs().maxCoeff();
    if (!(largest > 0.0f)) return;
    const auto step = [&](int axis) { return static_cast<int>(std::lround(way[axis] / largest)) + 1; };
    const int number = (step(0) * 3 + step(1)) * 3 + step(2);
    const auto k = static_cast<std::size_t>(number > 13 ? number - 1 : number);  // 13 would be no step at all
    if (!(body_.solid().steps[node] >> k & 1u)) return;
    const std::uint32_t next = body_.step(node, k);
    if (!sees_[next] || bone_[next] != bone_[node]) return;
    sees_[node] = true;
    distances_[node] = std::min(distances_[node], way.norm());
  }

  struct Entry {
    std::uint32_t node;
    float distance;
  };

  const BodyLattice& body_;
  std::span<const Segment> bones_;
  std::vector<float> distances_;
  std::vector<std::uint32_t> bone_;
  std::vector<bool> sees_;
  std::map<std::uint64_t, std::vector<Entry>> buckets_;  // by distance: a joint astray may be any number of cells away
  std::uint64_t current_ = 0;
  float width_;
};

std::vector<std::vector<Source>> all_sources(BodyLattice& body, std::span<const Segment> bones) {
  std::vector<std::vector<Source>> out(bones.size());
  const std::vector<std::uint32_t> piece = body.pieces();
  std::vector<bool> has_vertex(body.size(), false);
  for (std::uint32_t n = static_cast<std::uint32_t>(body.solid().nodes()); n < body.size(); ++n) has_vertex[piece[n]] = true;
  parallel_for(bones.size(), 1, [&](std::size_t begin, std::size_t) {
    const auto b = static_cast<std::uint32_t>(begin);
    out[b] = sources_of(b, bones[b], body, nullptr);
    std::erase_if(out[b], [&](const Source& s) { return !has_vertex[piece[s.node]]; });
    if (out[b].empty()) out[b] = sources_of(b, bones[b], body, &body.faces());
  });
  std::vector<std::uint32_t> nodes;
  for (const auto& sources : out)
    for (const Source& s : sources) nodes.push_back(s.node);
  body.join_to(nodes);
  return out;
}

Ways nearest_bones(const BodyLattice& body, std::span<const Segment> bones, const std::vector<std::vector<Source>>& sources) {
  std::vector<Source> together;
  for (const auto& some : sources) together.insert(together.end(), some.begin(), some.end());
  Ways ways(body, bones);
  ways.run(together, [](std::uint32_t, float) { return true; });
  return ways;
}

using Column = std::vector<std::pair<VertexId, float>>;  // of one bone: the vertices that are near enough, and how far they are

Column near_vertices(const BodyLattice& body, std::span<const Segment> bones, std::span<const Source> sources, const Ways& nearest,
                     const BoneDistanceOptions& options) {
  const float margin = options.margin * body.solid().cell;
  const auto is_near = [&](std::uint32_t node, float distance) { return distance <= options.reach * nearest.distance(node) + margin; };
  Ways ways(body, bones);
  ways.run(sources, is_near);
  Column out;
  for (std::uint32_t n = static_cast<std::uint32_t>(body.solid().nodes()); n < body.size(); ++n)
    if (const float d = ways.distance(n); std::isfinite(d) && is_near(n, d)) out.emplace_back(body.vertex(n), d);
  return out;
}

// Vertices that no bone is near to get the nearest by way of the body, or, where no way leads, in a straight line.
void give_everybody_a_bone(const BodyLattice& body, std::span<const Segment> bones, const Ways& nearest, std::vector<Column>& columns) {
  std::vector<bool> has_bone(body.size(), false);
  for (const Column& column : columns)
    for (const auto& [v, distance] : column) has_bone[body.node(v)] = true;
  for (std::uint32_t n = static_cast<std::uint32_t>(body.solid().nodes()); n < body.size(); ++n) {
    if (has_bone[n]) continue;
    std::size_t bone = nearest.bone(n);
    float distance = nearest.distance(n);
    if (!std::isfinite(distance))
      for (std::size_t b = 0; b < bones.size(); ++b)
        if (const float d = straight_distance(bones[b], body.position(n)); d < distance) {
          distance = d;
          bone = b;
        }
    columns[bone].emplace_back(body.vertex(n), distance);
  }
}

}  // namespace

BoneDistances bone_distances(BodyLattice& body, std::span<const Bone> list, const BoneDistanceOptions& options) {
  assert(!list.empty());
  const std::vector<Segment> bones = segments_of(list);
  const auto sources = all_sources(body, bones);
  const Ways nearest = nearest_bones(body, bones, sources);
  std::vector<Column> columns(bones.size());
  parallel_for(bones.size(), 1, [&](std::size_t b, std::size_t) { columns[b] = near_vertices(body, bones, sources[b], nearest, options); });
  const std::size_t vertices = body.size() - body.solid().nodes();
  give_everybody_a_bone(body, bones, nearest, columns);
  BoneDistances out;
  out.offsets.assign(vertices + 1, 0);
  for (const auto& column : columns)
    for (const auto& [v, distance] : column) ++out.offsets[index(v) + 1];
  for (std::size_t v = 0; v < vertices; ++v) out.offsets[v + 1] += out.offsets[v];
  out.items.resize(out.offsets.back());
  std::vector<std::uint32_t> next(out.offsets.begin(), out.offsets.end() - 1);
  for (std::uint32_t b = 0; b < bones.size(); ++b)
    for (const auto& [v, distance] : columns[b]) out.items[next[index(v)]++] = {b, distance};
  for (std::size_t v = 0; v < vertices; ++v)
    std::ranges::stable_sort(std::span(out.items).subspan(out.offsets[v], out.offsets[v + 1] - out.offsets[v]), {},
                             &BoneDistance::distance);
  return out;
}

void lengthen_past_ends(BoneDistances& distances, const PerVertex<Vec3f>& positions, std::span<const Bone> bones,
                        const Skeleton& skeleton) {
  assert(positions.size() == distances.size());
  parallel_for(positions.size(), kVerticesPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v) {
      const auto row = std::span(distances.items).subspan(distances.offsets[v], distances.offsets[v + 1] - distances.offsets[v]);
      for (auto& [b, distance] : row) {
        const Segment& s = bones[b].segment;
        const Vec3f& p = positions[static_cast<VertexId>(v)];
        const Vec3f way = (s.b - s.a).stableNormalized();
        const float past = bones[b].end ? std::max(0.0f, (p - s.b).dot(way)) : 0.0f;
        const float before = skeleton.parents[bones[b].start] ? std::max(0.0f, (s.a - p).dot(way)) : 0.0f;
        distance = std::sqrt(distance * distance + kPastEnd * past * past + kBeforeStart * before * before);
      }
      std::ranges::stable_sort(row, {}, &BoneDistance::distance);
    }
  });
}

std::vector<Bone> extended_to_middles(BodyLattice& body, std::span<const Bone> bones, float overshoot) {
  const std::vector<Segment> segments = segments_of(bones);
  auto sources = all_sources(body, segments);
  // A leaf's point is the end of its parent's bone too: what is as near to both belongs to the leaf.
  std::stable_partition(sources.begin(), sources.end(), [&](const auto& some) { return !some.empty() && !bones[some[0].bone].end; });
  const Ways nearest = nearest_bones(body, segments, sources);
  std::vector<Vec3f> sums(bones.size(), Vec3f::Zero());
  std::vector<float> counts(bones.size(), 0.0f);
  std::vector<bool> has_nodes(bones.size(), false);  // of the lattice: volume counts, else vertices
  for (std::uint32_t n = 0; n < body.size(); ++n) {
    const std::uint32_t b = nearest.bone(n);
    if (bones[b].end || !std::isfinite(nearest.distance(n)) || (body.is_vertex(n) && has_nodes[b])) continue;
    has_nodes[b] = has_nodes[b] || !body.is_vertex(n);
    sums[b] += body.position(n);
    counts[b] += 1.0f;
  }
  std::vector<Bone> out(bones.begin(), bones.end());
  for (std::size_t b = 0; b < bones.size(); ++b)
    if (!bones[b].end && counts[b] > 0.0f) out[b].segment.b += (1.0f + overshoot) * (sums[b] / counts[b] - out[b].segment.a);
  return out;
}

}  // namespace osteon::skin
