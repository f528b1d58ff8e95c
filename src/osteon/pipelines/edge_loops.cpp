// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/edge_loops.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "osteon/base/parallel.h"

namespace osteon::pipelines {
namespace {

constexpr float kCell = 0.001f;    // of the histograms along an axis
constexpr float kTail = 3.5f;      // standard deviations to which a Gaussian is summed
constexpr float kFarthest = 3.0f;  // times `reach` that a joint may move

// The line along which a joint may move.
struct Limb {
  Vec3f direction;      // unit, away from the parent
  float back, forward;  // how far
};

using Children = std::vector<std::vector<std::size_t>>;  // of each joint

std::optional<Limb> limb_at(std::size_t joint, const JointSet& joints, const JointTree& tree, const Children& children,
                            const EdgeLoopOptions& options) {
  if (!tree.parents[joint]) return std::nullopt;
  const Vec3f& here = joints.positions[joint];
  const Vec3f incoming = here - joints.positions[*tree.parents[joint]];
  if (incoming.norm() < options.shortest_bone) return std::nullopt;
  Vec3f outgoing = Vec3f::Zero();
  float straightest = 0.0f;
  for (std::size_t child : children[joint]) {
    const Vec3f bone = joints.positions[child] - here;
    const float straight = bone.norm() < options.shortest_bone ? 0.0f : bone.normalized().dot(incoming.normalized());
    if (straight <= straightest) continue;
    straightest = straight;
    outgoing = bone;
  }
  if (straightest <= 0.0f) return std::nullopt;
  Vec3f direction = incoming.normalized() + outgoing.normalized();
  if (joints.partner[joint] == joint) direction.x() = 0.0f;
  if (!(direction.norm() > 0.0f)) return std::nullopt;
  const float farthest = kFarthest * options.reach;
  return Limb{direction.normalized(), std::min(farthest, 0.5f * incoming.norm()), std::min(farthest, 0.5f * outgoing.norm())};
}

// How many vertices there are in each cell along the limb's axis, the joint at the middle of the middle cell.
std::vector<float> vertices_along(const Limb& limb, const Vec3f& joint, bool count_images, std::span<const Vec3f> vertices, int cells,
                                  float radius) {
  std::vector<float> count(static_cast<std::size_t>(cells), 0.0f);
  const auto add = [&](const Vec3f& p) {
    const Vec3f way = p - joint;
    const float along = way.dot(limb.direction);
    if ((way - along * limb.direction).squaredNorm() > radius * radius) return;
    const float place = along / kCell + static_cast<float>(cells / 2);
    if (!(place >= 0.0f && place < static_cast<float>(cells - 1))) return;
    // Shared by two cells, so that nothing jumps where rounding moves a vertex.
    const auto cell = static_cast<std::size_t>(place);
    const float part = place - static_cast<float>(cell);
    count[cell] += 1.0f - part;
    count[cell + 1] += part;
  };
  for (const Vec3f& p : vertices) {
    add(p);
    if (count_images) add(mirrored(p));
  }
  return count;
}

// Half of a Gaussian: its density at the middles of the cells, from the middle outwards.
std::vector<float> bell(float deviation) {
  std::vector<float> out;
  for (int k = 0; k <= static_cast<int>(std::ceil(kTail * deviation / kCell)); ++k) {
    const float z = kCell * static_cast<float>(k) / deviation;
    out.push_back(std::exp(-0.5f * z * z) / (deviation * std::sqrt(2.0f * std::numbers::pi_v<float>)));
  }
  return out;
}

// Per length, at the middle of a cell.
float smoothed(const std::vector<float>& count, std::size_t cell, const std::vector<float>& bell) {
  float sum = count[cell] * bell[0];
  for (std::size_t k = 1; k < bell.size(); ++k)
    sum += ((cell >= k ? count[cell - k] : 0.0f) + (cell + k < count.size() ? count[cell + k] : 0.0f)) * bell[k];
  return sum;
}

// How far the joint moves along its limb.
float shift(const Limb& limb, const Vec3f& joint, bool count_images, std::span<const Vec3f> vertices, const EdgeLoopOptions& options) {
  const float extent = kFarthest * options.reach + kTail * options.limb;
  const int half = static_cast<int>(std::ceil(extent / kCell)), cells = 2 * half + 1;
  const std::vector<float> count = vertices_along(limb, joint, count_images, vertices, cells, options.radius);
  const std::vector<float> loop = bell(options.loop), around = bell(options.limb);
  const float faint = count_images ? 2.0f * options.faint : options.faint;
  float moment = 0.0f, mass = 0.0f;
  for (int k = -static_cast<int>(limb.back / kCell); k <= static_cast<int>(limb.forward / kCell); ++k) {
    const float s = kCell * static_cast<float>(k);
    const auto cell = static_cast<std::size_t>(half + k);
    const float loops = (smoothed(count, cell, loop) + faint) / (smoothed(count, cell, around) + faint);
    const float likely = std::exp(-0.5f * s * s / (options.reach * options.reach)) * std::pow(loops, options.trust);
    moment += s * likely;
    mass += likely;
  }
  return moment / mass;
}

}  // namespace

JointSet drawn_to_edge_loops(const JointSet& joints, const JointTree& tree, std::span<const Vec3f> vertices,
                             const EdgeLoopOptions& options) {
  std::vector<Vec3f> seen;
  seen.reserve(vertices.size());
  for (const Vec3f& p : vertices) seen.push_back(joints.frame.to(p));
  Children children(joints.size());
  for (std::size_t j = 0; j < joints.size(); ++j)
    if (tree.parents[j]) children[*tree.parents[j]].push_back(j);
  JointSet out = joints;
  parallel_for(joints.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t j = begin; j < end; ++j) {
      const auto partner = joints.partner[j];
      if (partner && *partner < j) continue;  // moves as its image does
      const auto limb = limb_at(j, joints, tree, children, options);
      if (!limb) continue;
      out.positions[j] += shift(*limb, joints.positions[j], partner.has_value(), seen, options) * limb->direction;
      if (partner && *partner != j) out.positions[*partner] = mirrored(out.positions[j]);
    }
  });
  return out;
}

}  // namespace osteon::pipelines
