// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <vector>

#include "osteon/infer/rignet.h"
#include "osteon/pipelines/body.h"
#include "osteon/pipelines/confidence.h"
#include "osteon/rig/skeleton.h"

namespace osteon::pipelines {

struct PredictedSkeleton {
  Skeleton skeleton;                                         // in the body's frame, in the unit of the mesh
  std::vector<std::optional<JointEvidence>> joint_evidence;  // (J) none: a hand's joint; empty: no joints were found
  CharacterEvidence character_evidence = {};
};

// Votes -> joints -> tree -> hands -> joints drawn to edge loops. Notes bandwidth, confidences and warnings in `report`. Where no joints
// are found it is a single one in the middle, with confidence 0 and a warning.
PredictedSkeleton predict_skeleton(const Body& body, const infer::RignetModels& models, const RignetOptions& options, RigReport& report,
                                   Stages& stages);

}  // namespace osteon::pipelines
