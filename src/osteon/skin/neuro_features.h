// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "osteon/skin/bone_choices.h"
#include "osteon/skin/super_skeleton.h"

// What the NeuroSkinning networks (nets/neuroskinning.h) read of a body and its skeleton.
namespace osteon::skin {

constexpr int kChoiceFeatures = geometry::kBindFeatures + 5;  // those of bind_features.h; share, its logarithm, is largest, largest, number
constexpr int kJointFeatures = 16;
constexpr float kLeastShare = 0.003f;  // added to geometric shares before the logarithm

// A row for each vertex and joint that it may choose.
struct ChoiceRows {
  std::vector<float> features;           // (C,kChoiceFeatures)
  std::vector<float> log_shares;         // (C) of the geometric share: what the network's output is added to
  std::vector<std::int32_t> offsets{0};  // (V+1) rows of vertex v are offsets[v] .. offsets[v+1]-1
  std::vector<std::int32_t> joints;      // (C)
  std::vector<std::int32_t> chosen;      // (B) the joints that occur, ascending ...
  std::vector<float> joint_features;     // ... (B, kJointFeatures + kinds) and what each is; the last columns are 1 at its kind
};

// `normals` of unit length; everything in the frame of the networks. Kinds: those of the slots, fewer than `kinds`.
ChoiceRows choice_rows(std::span<const Vec3f> positions, std::span<const Vec3f> normals, const Skeleton& skeleton,
                       const BoneChoices& choices, const SuperSkeleton& super, const SlotAssignment& assignment, int kinds);

// The paper's vertex attributes (V, 6 + slots): position, normal, and the straight distance to the nearest bone of each slot's joint,
// kNoSlot for slots that the skeleton has not. Positions from the joint whose slot is the hips', or from the root.
constexpr float kNoSlot = 1.0f;
std::vector<float> slot_rows(std::span<const Vec3f> positions, std::span<const Vec3f> normals, const Skeleton& skeleton,
                             const SuperSkeleton& super, const SlotAssignment& assignment, int slots);

}  // namespace osteon::skin
