// SPDX-License-Identifier: Apache-2.0
#include "osteon/geometry/volumetric_geodesic.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <optional>
#include <queue>
#include <utility>
#include <vector>

#include "osteon/base/parallel.h"
#include "osteon/geometry/body_graph.h"
#include "osteon/geometry/body_lines.h"
#include "osteon/geometry/rignet_features.h"

namespace osteon::geometry {
namespace {

constexpr float kBridge = 0.02f;       // as in geodesic_balls
constexpr float kSampleStep = 0.02f;   // along a bone; two voxels of the 88^3 grid
constexpr float kMostSteps = 4096.0f;  // of a bone: longer ones, which lead to a joint astray, get longer steps
constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::size_t kVerticesPerTask = 32;

float parameter_of_nearest(const Segment& s, const Vec3f& p) {
  const Vec3f d = s.b - s.a;
  const float squared = d.squaredNorm();
  return squared > 1e-12f ? std::clamp((p - s.a).dot(d) / squared, 0.0f, 1.0f) : 0.0f;
}

// A point on a bone, and what surrounds it.
struct Sample {
  ClosestPoint surface;
  bool inside;
};

Vec3f point_at(const Segment& bone, float t) { return (1.0f - t) * bone.a + t * bone.b; }

std::vector<Sample> sampled(const Segment& bone, const BodyLines& lines) {
  const int steps = static_cast<int>(std::min(std::ceil((bone.b - bone.a).norm() / kSampleStep), kMostSteps));
  std::vector<Sample> samples;
  for (int i = 0; i <= steps; ++i) {
    const Vec3f p = point_at(bone, steps > 0 ? static_cast<float>(i) / static_cast<float>(steps) : 0.0f);
    samples.push_back({lines.surface().closest_point(p), lines.is_inside(p)});
  }
  return samples;
}

// A way to a vertex that may be its shortest from the bone: a straight one not looked along yet (the rank-th nearest bone in a straight
// line), or one over the graph (rank -1).
struct Label {
  float distance;
  std::int32_t vertex, bone, rank;
};

// The labels, nearest first. They wait unsorted in buckets of like distances; a bucket is sorted when its turn comes, and what is pushed
// into it from then on goes through a heap, which stays small. Pre: what is pushed is no nearer than what was popped last.
class LabelQueue {
 public:
  void push(const Label& label) {
    const auto bucket = static_cast<std::size_t>(std::min(label.distance / kWidth, kLastBucket));
    if (bucket <= current_) return late_.push(label);
    if (bucket >= buckets_.size()) buckets_.resize(bucket + 1);
    buckets_[bucket].push_back(label);
  }
  std::optional<Label> pop() {
    while (late_.empty() && sorted_.empty() && current_ + 1 < buckets_.size()) {
      sorted_ = std::exchange(buckets_[++current_], {});
      std::ranges::sort(sorted_, Later{});
    }
    if (late_.empty() && sorted_.empty()) return std::nullopt;
    if (late_.empty() || (!sorted_.empty() && !Later{}(sorted_.back(), late_.top()))) {
      const Label label = sorted_.back();
      sorted_.pop_back();
      return label;
    }
    const Label label = late_.top();
    late_.pop();
    return label;
  }

 private:
  static constexpr float kWidth = 0.002f, kLastBucket = 65535.0f;  // of a bucket, in the mesh's unit; the last holds all that is beyond
  struct Later {
    bool operator()(const Label& a, const Label& b) const { return a.distance > b.distance; }
  };
  std::vector<std::vector<Label>> buckets_;
  std::size_t current_ = 0;
  std::vector<Label> sorted_;  // what is left of the current bucket, the nearest last
  std::priority_queue<Label, std::vector<Label>, Later> late_;
};

// Ways from all bones at once, nearest first, so that a vertex can stop listening once it has heard of as many joints as are wanted: what
// is farther from it than these is also farther from everybody behind it.
class Ways {
 public:
  Ways(const TriangleMesh& mesh, const BodyLines& lines, std::span<const Segment> bones, const NearestJoints& wanted)
      : mesh_(mesh),
        lines_(lines),
        bones_(bones),
        wanted_(wanted),
        samples_(bones.size()),
        straight_(mesh.positions.size(), bones.size()),
        order_(mesh.positions.size(), bones.size()),
        sight_(mesh.positions.size() * bones.size(), Sight::unknown),
        shortest_(Matrix::Constant(columns(), rows(), kInfinity)),
        heard_(mesh.positions.size()),
        reach_(mesh.positions.size(), kInfinity) {
    parallel_for(bones.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t b = begin; b < end; ++b) samples_[b] = sampled(bones[b], lines);
    });
    parallel_for(mesh.positions.size(), kVerticesPerTask, [&](std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) look_around(static_cast<Eigen::Index>(v));
    });
  }

  Matrix run(const SurfaceGraph& body) {
    for (Eigen::Index b = 0; b < columns(); ++b) start_at_nearest_faces(b);
    for (Eigen::Index v = 0; v < rows(); ++v) look_next(v, 0);
    while (const auto next = queue_.pop()) {
      const Label& label = *next;
      if (label.rank >= 0) look_next(label.vertex, label.rank + 1);
      if (!is_wanted(label) || (label.rank >= 0 && !sees(label.vertex, label.bone))) continue;
      settle(label);
      for (const auto& [to, length] : body.of(static_cast<std::size_t>(label.vertex)))
        offer(static_cast<Eigen::Index>(to), label.bone, label.distance + length);
    }
    return settled();
  }

 private:
  enum class Sight : std::uint8_t { unknown, no, yes };
  struct Heard {
    std::int32_t bone;
    float distance;
  };

  static std::int32_t number(Eigen::Index i) { return static_cast<std::int32_t>(i); }

  Eigen::Index rows() const { return static_cast<Eigen::Index>(mesh_.positions.size()); }
  Eigen::Index columns() const { return static_cast<Eigen::Index>(bones_.size()); }
  int joint_of(Eigen::Index bone) const { return wanted_.joint_of[static_cast<std::size_t>(bone)]; }
  const Vec3f& position(Eigen::Index v) const { return mesh_.positions.raw()[static_cast<std::size_t>(v)]; }

  // All straight distances; and along those that will hardly be spared, whether the bone is seen, while there are many threads: half more
  // than are wanted, as some are not seen (of a biped's 1,200 vertices 2,300 lines in place of 5,600 are then left to one thread).
  void look_around(Eigen::Index v) {
    std::vector<std::pair<float, int>> by_distance;
    for (Eigen::Index b = 0; b < columns(); ++b) {
      const Segment& bone = bones_[static_cast<std::size_t>(b)];
      straight_(v, b) = (position(v) - point_at(bone, parameter_of_nearest(bone, position(v)))).norm();
      by_distance.emplace_back(straight_(v, b), static_cast<int>(b));
    }
    std::ranges::sort(by_distance);
    for (Eigen::Index b = 0; b < columns(); ++b) order_(v, b) = by_distance[static_cast<std::size_t>(b)].second;
    for (Eigen::Index i = 0; i < std::min<Eigen::Index>(wanted_.count + wanted_.count / 2, columns()); ++i) sees(v, order_(v, i));
  }

  bool sees(Eigen::Index v, Eigen::Index b) {
    Sight& known = sight_[static_cast<std::size_t>(v * columns() + b)];
    if (known != Sight::unknown) return known == Sight::yes;
    const Segment& bone = bones_[static_cast<std::size_t>(b)];
    const float t = parameter_of_nearest(bone, position(v));
    const std::vector<Sample>& samples = samples_[static_cast<std::size_t>(b)];
    const Sample& beside = samples[static_cast<std::size_t>(std::lround(t * static_cast<float>(samples.size() - 1)))];
    const bool is_seen = beside.inside && lines_.sees(point_at(bone, t), VertexId{static_cast<std::uint32_t>(v)});
    known = is_seen ? Sight::yes : Sight::no;
    return is_seen;
  }

  void look_next(Eigen::Index v, Eigen::Index rank) {
    if (rank == columns()) return;
    const Eigen::Index bone = order_(v, rank);
    if (const float distance = straight_(v, bone); distance <= reach(v)) queue_.push({distance, number(v), number(bone), number(rank)});
  }

  void start_at_nearest_faces(Eigen::Index bone) {
    for (const Sample& s : samples_[static_cast<std::size_t>(bone)])
      for (VertexId corner : mesh_.faces[s.surface.face])
        offer(static_cast<Eigen::Index>(index(corner)), bone, s.surface.distance + (mesh_.positions[corner] - s.surface.position).norm());
  }

  void offer(Eigen::Index v, Eigen::Index bone, float distance) {
    if (distance >= shortest_(bone, v) || distance > reach(v)) return;
    shortest_(bone, v) = distance;
    queue_.push({distance, number(v), number(bone), -1});
  }

  // How far the last of the wanted joints is, once all are known.
  float reach(Eigen::Index v) const { return reach_[static_cast<std::size_t>(v)]; }

  // Of a joint that is no nearer by another bone, and not known by a shorter way. Equal distances all count: which comes first is chance.
  bool is_wanted(const Label& label) const {
    if (label.distance > reach(label.vertex)) return false;
    return std::ranges::none_of(heard_[static_cast<std::size_t>(label.vertex)].bones, [&](const Heard& h) {
      return h.bone == label.bone || (joint_of(h.bone) == joint_of(label.bone) && h.distance < label.distance);
    });
  }

  void settle(const Label& label) {
    const auto v = static_cast<std::size_t>(label.vertex);
    auto& [bones, joints] = heard_[v];
    const bool is_new = std::ranges::none_of(bones, [&](const Heard& h) { return joint_of(h.bone) == joint_of(label.bone); });
    if (bones.empty()) bones.reserve(static_cast<std::size_t>(wanted_.count) + 2);
    bones.push_back({label.bone, label.distance});
    if (is_new && ++joints == wanted_.count) reach_[v] = label.distance;
    shortest_(label.bone, label.vertex) = label.distance;
  }

  Matrix settled() const {
    Matrix distances = Matrix::Constant(rows(), columns(), kInfinity);
    for (Eigen::Index v = 0; v < rows(); ++v)
      for (const Heard& h : heard_[static_cast<std::size_t>(v)].bones) distances(v, h.bone) = h.distance;
    return distances;
  }

  struct OfVertex {
    std::vector<Heard> bones;  // nearest first
    int joints = 0;            // that these start at
  };

  const TriangleMesh& mesh_;
  const BodyLines& lines_;
  std::span<const Segment> bones_;
  const NearestJoints& wanted_;
  std::vector<std::vector<Sample>> samples_;
  Matrix straight_;           // (V,B)
  IndexMatrix order_;         // (V,B) bones by straight distance
  std::vector<Sight> sight_;  // (V,B)
  Matrix shortest_;           // (B,V) the shortest way so far: a vertex and its neighbours hear of one bone at a time
  std::vector<OfVertex> heard_;
  std::vector<float> reach_;  // (V)
  LabelQueue queue_;
};

}  // namespace

Matrix volumetric_geodesic_distance(const TriangleMesh& mesh, const VoxelGrid& grid, std::span<const Segment> bones,
                                    const NearestJoints& wanted) {
  assert(!mesh.faces.empty() && wanted.joint_of.size() == bones.size() && wanted.count > 0);
  const BodyLines lines(mesh, grid);
  return Ways(mesh, lines, bones, wanted).run(body_graph(mesh, lines, kBridge));
}

Matrix volumetric_geodesic_distance(const TriangleMesh& mesh, const VoxelGrid& grid, std::span<const Segment> bones) {
  std::vector<int> each(bones.size());
  std::iota(each.begin(), each.end(), 0);
  return volumetric_geodesic_distance(mesh, grid, bones, {each, std::max(1, static_cast<int>(bones.size()))});
}

Matrix straight_distance(const TriangleMesh& mesh, std::span<const Segment> bones) {
  Matrix distances(mesh.positions.size(), bones.size());
  for (VertexId v : mesh.positions.ids())
    for (std::size_t b = 0; b < bones.size(); ++b) {
      const Vec3f& p = mesh.positions[v];
      distances(static_cast<Eigen::Index>(v), static_cast<Eigen::Index>(b)) =
          (p - point_at(bones[b], parameter_of_nearest(bones[b], p))).norm();
    }
  return distances;
}

}  // namespace osteon::geometry
