// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/joint_extraction.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

#include "osteon/pipelines/mean_shift.h"

namespace osteon::pipelines {
namespace {

// What takes part in the mean shift, in the mirror frame.
struct Votes {
  std::vector<Vec3f> positions;
  std::vector<float> weights;
  bool inside_used = true;
};

// Less than this share of the attention inside the volume says that there is no volume.
constexpr double kMinInside = 0.05;

Votes plausible_votes(const JointCandidates& candidates, const geometry::VoxelGrid& voxels, const MirrorFrame& frame, float min_attention) {
  const auto votes = [&](bool only_inside) {
    Votes out;
    out.inside_used = only_inside;
    for (std::size_t i = 0; i < candidates.positions.size(); ++i) {
      const Vec3f& q = candidates.positions[i];
      if (!(candidates.attention[i] > min_attention) || !q.allFinite() || (only_inside && !voxels.inside(q))) continue;
      out.positions.push_back(frame.to(q));
      out.weights.push_back(candidates.attention[i]);
    }
    return out;
  };
  const auto sum = [](const Votes& v) { return std::accumulate(v.weights.begin(), v.weights.end(), 0.0); };
  Votes inside = votes(true);
  Votes all = votes(false);
  return sum(inside) < kMinInside * sum(all) ? all : inside;
}

// Candidate indices by falling density; ties keep the order of the candidates, which is that of the canonical mesh.
std::vector<std::uint32_t> by_density(const std::vector<float>& density) {
  std::vector<std::uint32_t> order(density.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return density[a] > density[b]; });
  return order;
}

// How the threshold on the share follows the bandwidth h: the votes of one joint that a bandwidth smaller than their spread gathers grow
// faster than with it, nearly as its volume does.
float share_scale(float h) {
  const float ratio = h / kDefaultBandwidth;
  return ratio < 1.0f ? std::pow(ratio, 2.5f) : ratio;
}

struct Mode {
  Vec3f position;  // x == 0 for a mode on the plane; for a pair the one of the two that a candidate made
  bool is_pair;    // it and its mirror image
  float share;     // density as a share of all attention
};

// Visits the candidates by falling density; each that is left becomes a mode and removes what is within h of it and of its image.
std::vector<Mode> modes_of(const std::vector<Vec3f>& shifted, const std::vector<float>& share, Mirror mirror, float h) {
  std::vector<bool> suppressed(shifted.size(), false);
  std::vector<Mode> modes;
  for (std::uint32_t i : by_density(share)) {
    if (suppressed[i]) continue;
    Mode mode{shifted[i], mirror == Mirror::across_x, share[i]};
    if (mode.is_pair && std::abs(mode.position.x()) <= 0.5f * h) {
      mode.position.x() = 0.0f;
      mode.is_pair = false;
    }
    modes.push_back(mode);
    suppressed[i] = true;
    for (std::size_t j = 0; j < shifted.size(); ++j)
      if ((shifted[j] - mode.position).norm() <= h || (mode.is_pair && (shifted[j] - mirrored(mode.position)).norm() <= h))
        suppressed[j] = true;
  }
  return modes;
}

// Modes come by falling share: drops the thin tail, but keeps two.
void prune(std::vector<Mode>& modes, float min_share) {
  const auto joints_of = [](const Mode& m) { return m.is_pair ? 2 : 1; };
  std::size_t kept = 0;
  int joints = 0;
  while (kept < modes.size() && (modes[kept].share >= min_share || joints < 2)) joints += joints_of(modes[kept++]);
  modes.resize(kept);
}

// Attention of the candidates (without their images) that gather around a place.
double attention_at(const Vec3f& place, const std::vector<Vec3f>& shifted, const std::vector<float>& weights, float h) {
  double sum = 0.0;
  for (std::size_t i = 0; i < shifted.size(); ++i)
    if ((shifted[i] - place).norm() <= h) sum += static_cast<double>(weights[i]);
  return sum;
}

void add(JointSet& joints, const Vec3f& position, std::optional<std::size_t> partner) {
  joints.positions.push_back(position);
  joints.partner.push_back(partner);
}

// Whether the body reaches to within `reach` of a place of the mirror frame, along the axes.
bool body_near(const geometry::VoxelGrid& voxels, const MirrorFrame& frame, const Vec3f& place, float reach) {
  const Vec3f p = frame.from(place);
  for (int axis = 0; axis < 3; ++axis)
    for (const float step : {-reach, 0.0f, reach})
      if (voxels.inside(p + step * Vec3f::Unit(axis))) return true;
  return false;
}

void add_mode(JointSet& joints, const Mode& mode, const Votes& votes, const std::vector<Vec3f>& shifted, const geometry::VoxelGrid& voxels,
              Mirror mirror, const JointExtractionOptions& options) {
  const auto attention_near = [&](const Vec3f& place) { return attention_at(place, shifted, votes.weights, options.bandwidth); };
  const std::size_t next = joints.size();
  if (!mode.is_pair) return add(joints, mode.position, mirror == Mirror::off ? std::nullopt : std::optional(next));
  const double here = attention_near(mode.position), there = attention_near(mirrored(mode.position));
  const double needed = static_cast<double>(options.one_sided_share) * std::max(here, there);
  const auto missing = [&](double side, const Vec3f& place) {
    return side < needed && !(votes.inside_used && body_near(voxels, joints.frame, place, 0.5f * options.bandwidth));
  };
  if (missing(there, mirrored(mode.position))) return add(joints, mode.position, std::nullopt);
  if (missing(here, mode.position)) return add(joints, mirrored(mode.position), std::nullopt);
  const Vec3f left(std::abs(mode.position.x()), mode.position.y(), mode.position.z());
  add(joints, left, next + 1);
  add(joints, mirrored(left), next);
}

float explained_share(const JointSet& joints, const std::vector<Vec3f>& shifted, const std::vector<float>& weights, float h) {
  double near = 0.0, all = 0.0;
  for (std::size_t i = 0; i < shifted.size(); ++i) {
    all += static_cast<double>(weights[i]);
    if (std::ranges::any_of(joints.positions, [&](const Vec3f& p) { return (shifted[i] - p).norm() <= h; }))
      near += static_cast<double>(weights[i]);
  }
  return all > 0.0 ? static_cast<float>(near / all) : 0.0f;
}

std::vector<float> density_shares(const std::vector<Vec3f>& shifted, const std::vector<float>& weights, Mirror mirror, float h) {
  std::vector<float> density = kernel_density(shifted, weights, mirror, h);
  const double all = std::accumulate(weights.begin(), weights.end(), 0.0) * (mirror == Mirror::across_x ? 2.0 : 1.0);
  for (float& d : density) d = static_cast<float>(static_cast<double>(d) / all);
  return density;
}

// The votes that no joint explains: a straight limb says only roughly where its knee is, so the votes for it are spread over more than one
// bandwidth.
Votes unexplained(const Votes& votes, const std::vector<Vec3f>& shifted, const JointSet& joints, float reach) {
  Votes rest;
  rest.inside_used = votes.inside_used;
  for (std::size_t i = 0; i < shifted.size(); ++i) {
    if (std::ranges::any_of(joints.positions, [&](const Vec3f& p) { return (shifted[i] - p).norm() <= reach; })) continue;
    rest.positions.push_back(votes.positions[i]);
    rest.weights.push_back(votes.weights[i]);
  }
  return rest;
}

// Joints for what the first search left over, by one with twice its bandwidth, farther than that from those that there are.
void add_spread_joints(JointSet& joints, const Votes& rest, double all, const geometry::VoxelGrid& voxels, Mirror mirror,
                       JointExtractionOptions options) {
  if (rest.positions.empty()) return;
  const JointSet before = joints;
  options.bandwidth *= 2.0f;
  const float h = options.bandwidth;
  const auto shifted =
      mean_shift(rest.positions, rest.weights, mirror, {.bandwidth = h, .step = options.step, .rest = options.rest}).points;
  std::vector<float> shares = kernel_density(shifted, rest.weights, mirror, h);
  for (float& share : shares) share = static_cast<float>(static_cast<double>(share) / all);
  for (const Mode& mode : modes_of(shifted, shares, mirror, h)) {
    const auto taken = [&](const Vec3f& p) {
      return (p - mode.position).norm() <= h || (mirror == Mirror::across_x && (p - mirrored(mode.position)).norm() <= h);
    };
    if (mode.share >= options.spread_share && std::ranges::none_of(before.positions, taken))
      add_mode(joints, mode, rest, shifted, voxels, mirror, options);
  }
}

JointExtraction extract_from(const Votes& votes, const geometry::VoxelGrid& voxels, const MirrorFrame& frame, Mirror mirror,
                             const JointExtractionOptions& options) {
  JointExtraction out;
  out.joints.frame = frame;
  out.bandwidth = options.bandwidth;
  out.inside_used = votes.inside_used;
  const float h = options.bandwidth;
  const auto shifted =
      mean_shift(votes.positions, votes.weights, mirror, {.bandwidth = h, .step = options.step, .rest = options.rest}).points;
  std::vector<Mode> modes = modes_of(shifted, density_shares(shifted, votes.weights, mirror, h), mirror, h);
  prune(modes, options.min_share * share_scale(h) * std::sqrt(20.0f / options.expected_joints));
  for (const Mode& mode : modes) add_mode(out.joints, mode, votes, shifted, voxels, mirror, options);
  const double all = std::accumulate(votes.weights.begin(), votes.weights.end(), 0.0) * (mirror == Mirror::across_x ? 2.0 : 1.0);
  add_spread_joints(out.joints, unexplained(votes, shifted, out.joints, 1.5f * h), all, voxels, mirror, options);
  out.explained = explained_share(out.joints, shifted, votes.weights, h);
  return out;
}

float geometric(float from, float to, float t) { return from * std::pow(to / from, t); }

}  // namespace

float bandwidth_of_detail(float detail) {
  assert(detail >= 0.0f && detail <= 1.0f);
  return detail < 0.5f ? geometric(kCoarsestBandwidth, kDefaultBandwidth, 2.0f * detail)
                       : geometric(kDefaultBandwidth, kFinestBandwidth, 2.0f * detail - 1.0f);
}

JointExtraction extract_joints(const JointCandidates& candidates, const geometry::VoxelGrid& voxels, const std::optional<Plane>& symmetry,
                               const JointExtractionOptions& options) {
  assert(candidates.positions.size() == candidates.attention.size());
  const MirrorFrame frame = symmetry ? MirrorFrame::of(*symmetry) : MirrorFrame{};
  const Votes votes = plausible_votes(candidates, voxels, frame, options.min_attention);
  return extract_from(votes, voxels, frame, symmetry ? Mirror::across_x : Mirror::off, options);
}

JointExtraction extract_joint_count(const JointCandidates& candidates, const geometry::VoxelGrid& voxels,
                                    const std::optional<Plane>& symmetry, std::size_t count, const JointExtractionOptions& options) {
  const MirrorFrame frame = symmetry ? MirrorFrame::of(*symmetry) : MirrorFrame{};
  const Votes votes = plausible_votes(candidates, voxels, frame, options.min_attention);
  const auto at = [&](float detail) {
    JointExtractionOptions tried = options;
    tried.bandwidth = bandwidth_of_detail(detail);
    return extract_from(votes, voxels, frame, symmetry ? Mirror::across_x : Mirror::off, tried);
  };
  const auto miss = [&](const JointExtraction& e) { return std::max(e.joints.size(), count) - std::min(e.joints.size(), count); };
  // The number of joints grows with the detail, though not strictly: halve the interval, and keep the best that was seen.
  JointExtraction best = at(0.5f);
  const bool finer = best.joints.size() < count;
  float low = finer ? 0.5f : 0.0f, high = finer ? 1.0f : 0.5f;
  for (int step = 0; step < 10 && miss(best) > 0; ++step) {
    const float middle = 0.5f * (low + high);
    JointExtraction tried = at(middle);
    (tried.joints.size() < count ? low : high) = middle;
    if (miss(tried) < miss(best)) best = std::move(tried);
  }
  return best;
}

}  // namespace osteon::pipelines
