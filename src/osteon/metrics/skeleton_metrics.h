// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <span>

#include "osteon/rig/skeleton.h"

namespace osteon::metrics {

// How well a predicted skeleton meets a reference. Distances in the skeletons' own unit: by convention the shape's longest side is 1.
struct SkeletonScores {
  double iou;                 // 2 m / (predicted + reference), m = joints found
  double precision, recall;   // m / predicted, m / reference
  double cd_j2j;              // Chamfer distance between the joints
  double cd_j2b;              // of joints to the other's bones
  double cd_b2b;              // between the bones
  double tree_edit_distance;  // joints to delete, insert or replace; found joints are the same as their partners
};

// RigNet (sec. 5.1) as its author's later code evaluates it (MoRig; facts/metrics.md sec. 1):
// - A joint is found when its partner in the assignment with the least total distance is nearer than tolerances[reference joint].
// - Chamfer distances are 0.5 * (mean of nearest distances one way + the other way); bones are sampled every 0.005, ends included.
// `tolerances`: geometry::joint_tolerances of the reference. Pre: both skeletons satisfy validate().
SkeletonScores compare_skeletons(const Skeleton& predicted, const Skeleton& reference, const PerJoint<float>& tolerances);

// Points along every bone, round(length / step) equal steps each, both ends included; the joint itself for a skeleton of one joint.
std::vector<Vec3f> sample_bones(const Skeleton& skeleton, float step = 0.005f);

// 0.5 * (mean_a min_b |a - b| + mean_b min_a |a - b|). Pre: neither is empty.
double chamfer_distance(std::span<const Vec3f> a, std::span<const Vec3f> b);

// For each predicted joint the reference joint that it finds, if any: partners of the assignment nearer than the tolerance.
PerJoint<std::optional<JointId>> found_joints(const Skeleton& predicted, const Skeleton& reference, const PerJoint<float>& tolerances);

// Share of the pairs of reference joints that `predicted`, a tree of the same joints by name, connects or leaves apart as `reference` does
// (RigNet, table 4, "class. accuracy"). Throws Error when the joints are not the same.
double connectivity_accuracy(const Skeleton& predicted, const Skeleton& reference);

}  // namespace osteon::metrics
