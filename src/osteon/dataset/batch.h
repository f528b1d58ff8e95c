// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "osteon/dataset/augment.h"
#include "osteon/dataset/prepared.h"
#include "osteon/nets/graph.h"

namespace osteon::dataset {

// A character and what the batches need again and again.
struct Example {
  PreparedCharacter character;
  Matrix pair_features;                   // (P,8)
  std::vector<std::uint8_t> pair_labels;  // (P)
  std::vector<float> plane_distance;      // (J) to the plane of symmetry, or |x| where there is none
  Matrix skin_features;                   // (V,43)
  geometry::SkinTargets skin_targets;     // (V,5) and (V)
};

std::vector<Example> examples_of(std::vector<PreparedCharacter> characters);  // in parallel

// How often to draw each: groups of alike characters count with the root of their size, then categories with the root of theirs. Sum 1.
std::vector<double> sampling_weights(std::span<const Example> examples);

// `count` different indices, drawn with `weights`; count is cut to their number.
std::vector<std::size_t> draw(std::span<const double> weights, std::size_t count, Random& random);

struct BatchTargets {
  std::vector<float> attention;         // (V) 0 or 1
  std::vector<std::int32_t> root;       // (M) row of each mesh's root joint
  std::vector<float> connected;         // (P) 0 or 1
  std::vector<float> skin, skin_share;  // (V,5), rows sum to 1 or are 0; (V) which part of the vertex's weight these five can carry
};

struct Batch {
  nets::NetworkInputs inputs;  // joints: the reference ones
  BatchTargets targets;
};

// Which parts beside the mesh to fill in.
enum class Parts { joints, pairs, skin };

struct BatchOptions {
  Parts parts = Parts::joints;  // joints: attention too; pairs: joints too
  std::size_t neighbours = 10;  // geodesic ones of a vertex
};

// For training: every character placed anew, neighbours drawn anew, each pair of joints in random order.
Batch training_batch(std::span<const Example* const> examples, const BatchOptions& options, const AugmentOptions& augment, Random& random);

// For validation: nothing random; neighbours spread evenly; of each mesh first all pairs i < j, then the same as j, i.
Batch plain_batch(std::span<const Example* const> examples, const BatchOptions& options);

}  // namespace osteon::dataset
