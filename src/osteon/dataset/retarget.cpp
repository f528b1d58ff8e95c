// SPDX-License-Identifier: Apache-2.0
#include "osteon/dataset/retarget.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "osteon/skin/bone_names.h"

namespace osteon::dataset {
namespace {

using skin::BoneName;
using skin::Side;
template <class T>
using PerBipedJoint = std::array<T, kBipedJoints.size()>;

constexpr std::size_t kLeastInCommon = 12;
constexpr std::size_t kSide = 4;  // as many joints has an arm, or a leg: the right one's follow after the left one's

// Places in kBipedJoints.
enum : std::size_t { hips, spine, neck = 4, head, left_shoulder, left_arm, left_forearm, left_hand, left_thigh = 14, left_calf };

// Joints whose bone leads to the next of kBipedJoints and points where the clip's does. The trunk's and the feet's do not: where artists
// put these joints differs by more than how bodies stand.
constexpr bool points_as_in_clip(std::size_t b) {
  const auto is_either = [b](std::size_t left) { return b == left || b == left + kSide; };
  return is_either(left_arm) || is_either(left_forearm) || is_either(left_thigh) || is_either(left_calf);
}
constexpr bool is_hand(std::size_t b) { return b == left_hand || b == left_hand + kSide; }

PerBipedJoint<BoneName> names_by_side() {
  PerBipedJoint<BoneName> names;
  names[neck] = {"neck", Side::none};
  names[head] = {"head", Side::none};
  constexpr std::array arm{"clavicle", "upperarm", "forearm", "hand"}, leg{"thigh", "calf", "foot", "toe"};
  for (std::size_t k = 0; k < kSide; ++k) {
    names[left_shoulder + k] = {arm[k], Side::left};
    names[left_shoulder + kSide + k] = {arm[k], Side::right};
    names[left_thigh + k] = {leg[k], Side::left};
    names[left_thigh + kSide + k] = {leg[k], Side::right};
  }
  return names;
}

std::vector<JointId> way_up(const Skeleton& skeleton, JointId from) {
  std::vector<JointId> way{from};
  while (const auto parent = skeleton.parents[way.back()]) way.push_back(*parent);
  return way;
}

std::optional<JointId> where_they_meet(const Skeleton& skeleton, JointId a, JointId b) {
  const std::vector<JointId> above_b = way_up(skeleton, b);
  for (const JointId j : way_up(skeleton, a))
    if (std::ranges::find(above_b, j) != above_b.end()) return j;
  return std::nullopt;
}

// The joints between hips and neck as the three of the spine: of few some stay empty, of many those in between follow the joint above.
void find_spine(const Skeleton& skeleton, BipedJoints& joints) {
  const auto top = joints[neck] ? joints[neck] : joints[head];
  if (!top) return;
  std::vector<JointId> between;  // from the top down
  for (const JointId j : way_up(skeleton, *top)) {
    if (j == *joints[hips]) break;
    if (j != *top) between.push_back(j);
  }
  const std::size_t n = between.size();
  for (std::size_t k = 0; k < std::min<std::size_t>(n, 3); ++k) joints[spine + k] = between[n - 1 - (n <= 3 ? k : k * (n - 1) / 2)];
}

PerBipedJoint<std::optional<std::size_t>> joints_of(const Motion& motion) {
  PerBipedJoint<std::optional<std::size_t>> out;
  for (std::size_t b = 0; b < out.size(); ++b) {
    const auto found = std::ranges::find(motion.names, kBipedJoints[b]);
    if (found != motion.names.end()) out[b] = static_cast<std::size_t>(found - motion.names.begin());
  }
  return out;
}

// The turn about y from the character's frame to that in which left is +x: clips are in that one.
Eigen::Matrix3f to_facing_forwards(const Skeleton& skeleton, const BipedJoints& joints) {
  Vec3f left = Vec3f::Zero();
  for (const std::size_t limb : {left_shoulder, left_thigh})
    for (std::size_t b = limb; b < limb + kSide; ++b)
      if (joints[b] && joints[b + kSide]) left += skeleton.rest_positions[*joints[b]] - skeleton.rest_positions[*joints[b + kSide]];
  return Eigen::AngleAxisf(std::atan2(left.z(), left.x()), Vec3f::UnitY()).toRotationMatrix();
}

Eigen::Matrix3f turn_between(const Vec3f& from, const Vec3f& to) { return Quatf::FromTwoVectors(from, to).toRotationMatrix(); }

// Global turns from the rest pose, in the frame facing forwards, of the joints that both have.
class Turns {
 public:
  Turns(const Skeleton& skeleton, const BipedJoints& joints, const Eigen::Matrix3f& forwards, const Motion& motion, std::size_t pose)
      : skeleton_(skeleton),
        joints_(joints),
        in_clip_(joints_of(motion)),
        forwards_(forwards),
        motion_(motion),
        posed_(motion.poses[pose]) {}

  bool both(std::size_t b) const { return joints_[b] && in_clip_[b]; }

  Eigen::Matrix3f of(std::size_t b) const {
    if (points_as_in_clip(b) && both(b + 1)) {
      const Eigen::Matrix3f turned = clip_turn(b) * between_rests(b);
      return turn_between(turned * own_way(b), way(posed_, b)) * turned;  // joints that move by position channels point elsewhere
    }
    if (is_hand(b) && both(b - 1)) return clip_turn(b) * between_rests(b - 1);
    return clip_turn(b);
  }

 private:
  Eigen::Matrix3f clip_turn(std::size_t b) const {
    const std::size_t j = *in_clip_[b];
    return posed_[j].rotation() * motion_.rest[j].rotation().transpose();
  }
  Eigen::Matrix3f between_rests(std::size_t b) const { return turn_between(own_way(b), way(motion_.rest, b)); }
  Vec3f own_way(std::size_t b) const {
    return forwards_ * (skeleton_.rest_positions[*joints_[b + 1]] - skeleton_.rest_positions[*joints_[b]]);
  }
  Vec3f way(const std::vector<Transform>& of_clip, std::size_t b) const {
    return of_clip[*in_clip_[b + 1]].translation() - of_clip[*in_clip_[b]].translation();
  }

  const Skeleton& skeleton_;
  const BipedJoints& joints_;
  PerBipedJoint<std::optional<std::size_t>> in_clip_;
  const Eigen::Matrix3f& forwards_;
  const Motion& motion_;
  const std::vector<Transform>& posed_;
};

}  // namespace

BipedJoints biped_joints(const Skeleton& skeleton) {
  static const PerBipedJoint<BoneName> names = names_by_side();
  BipedJoints joints;
  for (JointId j : skeleton.names.ids()) {
    BoneName name = skin::bone_name(skeleton.names[j]);
    if (name.kind.ends_with(".1")) name.kind.resize(name.kind.size() - 2);
    const auto found = std::ranges::find(names, name);
    if (!name.kind.empty() && found != names.end() && !joints[static_cast<std::size_t>(found - names.begin())])
      joints[static_cast<std::size_t>(found - names.begin())] = j;
  }
  if (!joints[left_thigh] || !joints[left_thigh + kSide]) return {};
  joints[hips] = where_they_meet(skeleton, *joints[left_thigh], *joints[left_thigh + kSide]);
  find_spine(skeleton, joints);
  return joints;
}

std::optional<Articulation> retargeted(const Skeleton& skeleton, const Motion& motion, std::size_t pose) {
  const BipedJoints joints = biped_joints(skeleton);
  const Eigen::Matrix3f forwards = to_facing_forwards(skeleton, joints);
  const Turns turns(skeleton, joints, forwards, motion, pose);
  PerJoint<std::optional<Eigen::Matrix3f>> turned(skeleton.size());
  std::size_t in_common = 0;
  for (std::size_t b = 0; b < kBipedJoints.size(); ++b)
    if (turns.both(b)) {
      turned[*joints[b]] = forwards.transpose() * turns.of(b) * forwards;
      ++in_common;
    }
  if (in_common < kLeastInCommon) return std::nullopt;
  Articulation out{PerJoint<Eigen::Matrix3f>(skeleton.size(), Eigen::Matrix3f::Identity()), skeleton.rest_positions};
  for (JointId j : skeleton.names.ids()) {
    const auto parent = skeleton.parents[j];
    if (parent) {
      out.linear[j] = out.linear[*parent];
      out.joints[j] = out.joints[*parent] + out.linear[*parent] * (skeleton.rest_positions[j] - skeleton.rest_positions[*parent]);
    }
    if (turned[j]) out.linear[j] = *turned[j];
  }
  return out;
}

}  // namespace osteon::dataset
