// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/pipelines/confidence.h"

// Written by scripts/calibrate for the networks in models/rignet; run it again when they, or how joints are found, change.
namespace osteon::pipelines {

constexpr Logistic<kJointEvidence.size()> kJointFit{0.35331f, {0.0000f, 3.3047f, 0.32067f}};

constexpr Logistic<kCharacterEvidence.size()> kCharacterFit{-4.9387f, {5.7188f, 4.7130f, 0.71062f}};

// Below this confidence a rig should not be used unseen.
constexpr float kLowConfidence = 0.138f;

}  // namespace osteon::pipelines
