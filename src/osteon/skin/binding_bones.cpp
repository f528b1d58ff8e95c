// SPDX-License-Identifier: Apache-2.0
#include "osteon/skin/binding_bones.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>

#include "osteon/skin/bone_distances.h"

namespace osteon::skin {
namespace {

constexpr float kAlong = 0.97f, kTowardsChild = 0.9f;  // cosines between the axis and the way to a child
constexpr float kAgreement = 0.6f;                     // share of the votes
constexpr int kVotesForY = 2;                          // before any joint is asked
constexpr float kSideShare = 0.9f;                     // of a bone to a child that the axis does not point at
constexpr float kSameAxes = 0.1f;                      // radians: joints that differ by less tell nothing
constexpr float kMiddleOvershoot = 0.5f;

Vec3f along(std::size_t signed_axis) {
  Vec3f out = Vec3f::Zero();
  out[static_cast<Eigen::Index>(signed_axis / 2)] = signed_axis % 2 == 0 ? 1.0f : -1.0f;
  return out;
}

bool have_axes(const Skeleton& skeleton) {
  return std::ranges::any_of(skeleton.rest_orientations,
                             [&](const Quatf& q) { return q.angularDistance(skeleton.rest_orientations[JointId{0}]) > kSameAxes; });
}

Vec3f direction(const Skeleton& skeleton, JointId from, JointId to) {
  return (skeleton.rest_positions[to] - skeleton.rest_positions[from]).stableNormalized();
}

// End joints, which only say how long the bone before them is: "HeadTop_End", "Toe0Nub".
bool is_end_joint(std::string name) {
  std::ranges::transform(name, name.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return name.ends_with("end") || name.ends_with("nub");
}

// The child that the joint's axis points at.
std::optional<JointId> child_along(const Skeleton& skeleton, const std::vector<JointId>& children, JointId joint, const Vec3f& axis) {
  std::optional<JointId> best;
  float most = kTowardsChild;
  for (JointId child : children)
    if (const float cosine = direction(skeleton, joint, child).dot(axis); cosine > most) {
      most = cosine;
      best = child;
    }
  return best;
}

// How far the body goes on from a point inside, in the direction; 0 outside.
float way_out(const Vec3f& from, const Vec3f& direction, const geometry::SolidLattice& solid) {
  const float step = 0.5f * solid.cell;
  float length = 0.0f;
  while (solid.node_at(solid.cell_at(from + length * direction)) != geometry::SolidLattice::kNone) length += step;
  return length;
}

void extend(Bone& bone, const Vec3f& axis, const geometry::BodyLattice& body, float overshoot) {
  float length = way_out(bone.segment.a, axis, body.solid());
  if (length == 0.0f)
    if (const auto hit = body.surface().first_hit(bone.segment.a, axis)) length = hit->distance;
  bone.segment.b = bone.segment.a + (1.0f + overshoot) * length * axis;
}

}  // namespace

std::optional<Vec3f> bone_axis(const Skeleton& skeleton) {
  if (!have_axes(skeleton)) return std::nullopt;
  const auto kids = children(skeleton);
  std::array<int, 6> votes{};
  int voters = votes[2] = kVotesForY;
  for (JointId j : skeleton.names.ids()) {
    if (kids[j].size() != 1) continue;
    const Vec3f way = skeleton.rest_orientations[j].conjugate() * direction(skeleton, j, kids[j][0]);
    if (way.isZero()) continue;
    ++voters;
    for (std::size_t a = 0; a < votes.size(); ++a) votes[a] += way.dot(along(a)) > kAlong;
  }
  const auto best = std::ranges::max_element(votes);
  if (static_cast<float>(*best) < kAgreement * static_cast<float>(voters)) return std::nullopt;
  return along(static_cast<std::size_t>(best - votes.begin()));
}

std::vector<Bone> binding_bones(const Skeleton& skeleton, geometry::BodyLattice& body, float overshoot) {
  std::vector<Bone> all = bones(skeleton);
  if (skeleton.size() > 1) std::erase_if(all, [&](const Bone& b) { return !b.end && is_end_joint(skeleton.names[b.start]); });
  const auto axis = bone_axis(skeleton);
  if (!axis) return extended_to_middles(body, all, kMiddleOvershoot);
  const auto kids = children(skeleton);
  std::vector<Bone> out;
  for (const Bone& bone : all) {
    const Vec3f own_axis = skeleton.rest_orientations[bone.start] * *axis;
    bool shortened = false;
    if (kids[bone.start].size() > 1)
      if (const auto main = child_along(skeleton, kids[bone.start], bone.start, own_axis); main && bone.end != main) shortened = true;
    out.push_back(bone);
    if (shortened) out.back().segment.b = bone.segment.a + kSideShare * (bone.segment.b - bone.segment.a);
    if (!bone.end) extend(out.back(), own_axis, body, overshoot);
  }
  return out;
}

}  // namespace osteon::skin
