// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "osteon/rig/skeleton.h"
#include "osteon/skin/bone_names.h"

namespace osteon::skin {

// One place for a joint in the super skeleton.
struct Slot {
  BoneName name;                   // kind empty: of joints whose names say nothing
  Vec3f position = Vec3f::Zero();  // mean of the joints that it was made of; left at +x
  int kind = 0;                    // the same for left and right

  bool operator==(const Slot&) const = default;
};

// How a skeleton's joints fall on the slots.
struct SlotAssignment {
  PerJoint<std::size_t> slot;  // no slot twice, unless there are more joints than slots: then with one above
  PerJoint<bool> by_name;      // the slot is of the joint's kind
};

struct SuperSkeletonOptions {
  std::size_t slots = 256, kinds = 160;  // at most
  std::size_t unspecific = 64;           // of the slots, for joints whose names say nothing
  double least_support = 0.3;            // skeletons that a kind must be seen in; n of one group count as sqrt(n) together
};

// A skeleton whose joints are the basis of the super skeleton, in the frame of the networks: longest side 1, feet on y = 0, centred.
struct NamedSkeleton {
  const Skeleton* skeleton;
  std::string group;  // of alike skeletons, which do not count each
};

// The union of all joints of many skeletons (Liu et al., NeuroSkinning, 2019, sec. 4.1), found without labels: a slot for every kind and
// side of a joint's name that many have, where they usually stand; and slots by place alone for all other joints. What the paper aligned
// by hand is aligned by names (bone_names.h) and places.
class SuperSkeleton {
 public:
  SuperSkeleton() = default;
  explicit SuperSkeleton(std::vector<Slot> slots) : slots_(std::move(slots)) {}

  const std::vector<Slot>& slots() const { return slots_; }

  // The assignment of joints to slots of least total cost, which counts kind, side and place. Names decide where they are known; left
  // and right fall on the slots of their sides. `known`: whether names are read; else places alone. Pre: there are slots.
  SlotAssignment assign(const Skeleton& skeleton, bool known = true) const;

  std::string to_json() const;
  static SuperSkeleton from_json(std::string_view text);  // throws Error

 private:
  std::vector<Slot> slots_;
};

SuperSkeleton learn_super_skeleton(std::span<const NamedSkeleton> skeletons, const SuperSkeletonOptions& options = {});

}  // namespace osteon::skin
