// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/confidence.h"

#include <algorithm>
#include <cassert>
#include <numeric>

#include "osteon/geometry/bvh.h"
#include "osteon/pipelines/confidence_fit.h"

namespace osteon::pipelines {
namespace {

constexpr float kReach = 0.06f;  // of votes for a joint: twice the default bandwidth

// Keeps logarithms finite; far below what makes a difference.
float log_of(float value) { return std::log(std::max(value, 1e-4f)); }

// The votes near a place, each with attention times 1 - (distance / reach)^2.
struct Nearby {
  float weight = 0.0f, attention = 0.0f;  // sum of the weights; weighted mean
};

Nearby votes_near(const JointCandidates& votes, const Vec3f& place) {
  Nearby out;
  for (std::size_t i = 0; i < votes.positions.size(); ++i) {
    const float part = (votes.positions[i] - place).squaredNorm() / (kReach * kReach);
    if (!(part < 1.0f)) continue;
    const float weight = votes.attention[i] * (1.0f - part);
    out.weight += weight;
    out.attention += weight * votes.attention[i];
  }
  if (out.weight > 0.0f) out.attention /= out.weight;
  return out;
}

JointEvidence mean(const JointEvidence& a, const JointEvidence& b) {
  JointEvidence out;
  for (std::size_t k = 0; k < out.size(); ++k) out[k] = 0.5f * (a[k] + b[k]);
  return out;
}

}  // namespace

std::vector<JointEvidence> joint_evidence(const JointCandidates& votes, const JointSet& joints, const TriangleMesh& working_mesh) {
  const geometry::Bvh surface(working_mesh);
  const float all = std::accumulate(votes.attention.begin(), votes.attention.end(), 0.0f);
  std::vector<JointEvidence> evidence;
  for (const Vec3f& p : joints.normalised()) {
    const Nearby near = votes_near(votes, p);
    evidence.push_back({log_of(all > 0.0f ? near.weight / all : 0.0f), near.attention, log_of(surface.closest_point(p).distance)});
  }
  for (std::size_t j = 0; j < joints.size(); ++j)
    if (const auto partner = joints.partner[j]; partner && *partner > j)
      evidence[j] = evidence[*partner] = mean(evidence[j], evidence[*partner]);
  return evidence;
}

CharacterEvidence character_evidence(const std::vector<JointEvidence>& joints, float explained, float likelihood) {
  assert(!joints.empty());
  float shares = 0.0f;
  for (const JointEvidence& joint : joints) shares += joint[0];
  return {explained, likelihood, shares / static_cast<float>(joints.size())};
}

float joint_confidence(const JointEvidence& evidence) { return kJointFit(evidence); }

float character_probability(const CharacterEvidence& evidence) { return kCharacterFit(evidence); }

}  // namespace osteon::pipelines
