// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/pipelines/confidence.h"

// Written by scripts/calibrate for the networks in models/rignet; run it again
// when they, or how joints are found, change.
namespace osteon::pipelines {

constexpr Logistic<kJointEvidence.size()> kJointFit{1.9245f, {0.52332f, 1.7956f, 0.20114f}};

constexpr Logistic<kCharacterEvidence.size()> kCharacterFit{3.9959f, {5.1246f, -3.0442f, 1.6333f}};

// Below this confidence a rig should not be used unseen.
constexpr float kLowConfidence = 0.016f;

}  // namespace osteon::pipelines
