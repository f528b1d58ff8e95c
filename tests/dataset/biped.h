// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "osteon/base/error.h"
#include "osteon/dataset/retarget.h"
#include "osteon/rig/skeleton.h"

namespace osteon::test {

// Facing +z, in a T or with arms at 45 degrees downwards; all of dataset::kBipedJoints but the third of the spine, by the same names.
inline Skeleton biped(bool arms_down) {
  Skeleton s;
  const auto add = [&](const char* name, int parent, Vec3f at) {
    return static_cast<int>(s.add(name, parent < 0 ? std::nullopt : std::optional(JointId(static_cast<std::uint16_t>(parent))), at));
  };
  const int hips = add("Hips", -1, {0, 1, 0}), spine = add("Spine", hips, {0, 1.15f, 0}), chest = add("Spine1", spine, {0, 1.3f, 0.02f});
  add("Head", add("Neck", chest, {0, 1.5f, 0}), {0, 1.6f, 0.02f});
  const Vec3f along = arms_down ? Vec3f(Vec3f(1, -1, 0).normalized()) : Vec3f(1, 0, 0);
  for (const float side : {1.0f, -1.0f}) {
    const std::string name = side > 0 ? "Left" : "Right";
    const auto at = [&](const Vec3f& p) { return Vec3f(side * p.x(), p.y(), p.z()); };
    const Vec3f shoulder(0.2f, 1.45f, 0);
    int joint = add((name + "Shoulder").c_str(), chest, at({0.05f, 1.45f, 0}));
    joint = add((name + "Arm").c_str(), joint, at(shoulder));
    joint = add((name + "ForeArm").c_str(), joint, at(shoulder + 0.3f * along));
    add((name + "Hand").c_str(), joint, at(shoulder + 0.55f * along));
    joint = add((name + "UpLeg").c_str(), hips, at({0.1f, 0.95f, 0}));
    joint = add((name + "Leg").c_str(), joint, at({0.1f, 0.5f, 0}));
    joint = add((name + "Foot").c_str(), joint, at({0.1f, 0.08f, 0}));
    add((name + "ToeBase").c_str(), joint, at({0.1f, 0, 0.15f}));
  }
  return s;
}

inline JointId joint_of(const Skeleton& skeleton, std::string_view name) {
  for (JointId j : skeleton.names.ids())
    if (skeleton.names[j] == name) return j;
  throw Error("no joint {}", name);
}

// The skeleton's rest pose as a clip of one pose in which each joint named turns about its place, with all below it.
inline Motion clip_of(const Skeleton& skeleton, const std::vector<std::pair<std::string_view, Quatf>>& turns) {
  Motion motion;
  std::vector<Transform> posed;
  for (JointId j : skeleton.names.ids()) {
    motion.names.push_back(skeleton.names[j]);
    motion.rest.emplace_back(Eigen::Translation3f(skeleton.rest_positions[j]));
    const auto parent = skeleton.parents[j];
    Transform local(Eigen::Translation3f(skeleton.rest_positions[j] - (parent ? skeleton.rest_positions[*parent] : Vec3f(0, 0, 0))));
    for (const auto& [name, turn] : turns)
      if (name == skeleton.names[j]) local.rotate(turn);
    posed.push_back(parent ? Transform(posed[index(*parent)] * local) : local);
  }
  motion.poses.push_back(std::move(posed));
  return motion;
}

}  // namespace osteon::test
