// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "osteon/dataset/augment.h"
#include "osteon/dataset/prepared.h"
#include "osteon/geometry/vote_features.h"
#include "osteon/nets/graph.h"
#include "osteon/skin/bone_choices.h"
#include "osteon/skin/super_skeleton.h"

namespace osteon::dataset {

// A character and what the batches need again and again.
struct Example {
  PreparedCharacter character;
  std::optional<Plane> symmetry;          // of the mesh
  std::vector<float> plane_distance;      // (J) to the plane of symmetry, or |x| where there is none
  geometry::VoteFeatures vote_features;   // joints only
  Matrix pair_features;                   // (P,8); pairs only
  std::vector<std::uint8_t> pair_labels;  // (P); pairs only
  Matrix inside;                          // (J,J) share of the way between two joints that is inside; tree only
  Matrix skin_features;                   // (V,43); skin only
  geometry::IndexMatrix choices;          // (V,8) the bones that each vertex may follow, -1: none; bind only
  geometry::SkinTargets skin_targets;     // skin: (V,5) and (V); bind: (V,8) and (V), 0 where there are fewer bones; neuro: (V,10) and (V)
  skin::BoneChoices bone_choices;         // neuro only
  geometry::GeodesicBalls wide_balls;     // the 63 nearest vertices of each; neuro and neuro_2019 only
};

std::vector<Example> examples_of(std::vector<PreparedCharacter> characters, Parts parts);  // in parallel

// How often to draw each: groups of alike characters count with the root of their size, then categories with the root of theirs. Sum 1.
std::vector<double> sampling_weights(std::span<const Example> examples);

// `count` different indices, drawn with `weights` (finite, not negative); count is cut to the number of those that are not 0.
std::vector<std::size_t> draw(std::span<const double> weights, std::size_t count, Random& random);

struct BatchTargets {
  std::vector<float> attention;         // (V) 0 or 1
  std::vector<std::int32_t> root;       // (M) row of each mesh's root joint
  std::vector<float> connected;         // (P) 0 or 1; pairs only
  std::vector<std::int64_t> parents;    // (J) within the skeleton, the root's is itself; tree only
  std::vector<float> skin, skin_share;  // (V,5), bind: (V,8), rows sum to 1 or are 0; (V) which part of the vertex's weight these can carry
                                        // neuro: (C) of each row; neuro_2019: (V,slots)
  std::vector<float> log_shares;        // (C) geometric, neuro only
  std::vector<float> slots;             // (V,slots) 0 for those that the skeleton has, else a large negative number; neuro_2019 only
};

struct Batch {
  nets::NetworkInputs inputs;  // joints: the reference ones
  BatchTargets targets;
};

struct BatchOptions {
  Parts parts = Parts::joints;                                     // joints: attention too; pairs: joints too; tree: joints alone, no mesh
  std::size_t neighbours = 10;                                     // geodesic ones of a vertex
  std::shared_ptr<const skin::SuperSkeleton> super_skeleton = {};  // neuro and neuro_2019
  bool hide_mesh = false, hide_joints = false;                     // their positions are noise: what do the pairs' own features tell alone?
};

// The example itself, which must then live on, or one made of it: moved through its rig; without some accessories; with fewer joints; its
// mesh reduced; its surface cut into other triangles. What is off draws no random number.
std::shared_ptr<const Example> varied(const Example& example, Parts parts, const AugmentOptions& options, Random& random);

// For training: every character placed anew, neighbours drawn anew, each pair of joints in random order. Of `augment` it reads where
// characters may be placed and how wrong joints and their number may be.
Batch training_batch(std::span<const Example* const> examples, const BatchOptions& options, const AugmentOptions& augment, Random& random);

// For validation: nothing random; neighbours spread evenly; of each mesh first all pairs i < j, then the same as j, i.
Batch plain_batch(std::span<const Example* const> examples, const BatchOptions& options);

}  // namespace osteon::dataset
