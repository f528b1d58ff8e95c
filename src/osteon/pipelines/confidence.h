// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "osteon/base/types.h"
#include "osteon/mesh/triangle_mesh.h"
#include "osteon/pipelines/joint_extraction.h"

// How likely a result is right, learned from characters whose rig is known: `osteon evaluate --calibration` measures and fits,
// confidence_fit.h holds what it found.
namespace osteon::pipelines {

// p = 1 / (1 + exp(-(bias + sum_k factors[k] x[k])))
template <std::size_t N>
struct Logistic {
  float bias;
  std::array<float, N> factors;

  float operator()(const std::array<float, N>& x) const {
    float sum = bias;
    for (std::size_t k = 0; k < N; ++k) sum += factors[k] * x[k];
    return 1.0f / (1.0f + std::exp(-sum));
  }
};

// What tells whether a joint is right. Lengths: longest side 1.
constexpr std::array kJointEvidence{
    "log of the share of all attention that points to within 0.06 of the joint, nearer votes counting more",
    "mean attention of these votes",
    "log of the distance to the surface",
};
using JointEvidence = std::array<float, kJointEvidence.size()>;

// What tells whether a shape is a character at all.
constexpr std::array kCharacterEvidence{
    "share of the attention that points at a joint",
    "geometric mean of the probabilities of the bones",
    "mean over the joints of the log of their share",
};
using CharacterEvidence = std::array<float, kCharacterEvidence.size()>;

// (J) in the order of the joint set; mirror partners get the mean of both. Pre: the mesh has faces.
std::vector<JointEvidence> joint_evidence(const JointCandidates& votes, const JointSet& joints, const TriangleMesh& working_mesh);

// `joints` not empty; `explained` of the joint extraction, `likelihood` of the tree.
CharacterEvidence character_evidence(const std::vector<JointEvidence>& joints, float explained, float likelihood);

// The probability that the joint lies within the tolerance of RigNet's measures (half the local diameter) of a joint that an artist would
// have made, each of which counts for one joint only; of a character.
float joint_confidence(const JointEvidence& evidence);

// The probability that the shape is a character, where as many other things come as characters.
float character_probability(const CharacterEvidence& evidence);

}  // namespace osteon::pipelines
