// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/pipelines/confidence.h"

// Written by scripts/calibrate for the networks in models/rignet; run it again when they, or how joints are found, change.
namespace osteon::pipelines {

constexpr Logistic<kJointEvidence.size()> kJointFit{0.41601f, {0.044862f, 2.9801f, 0.26052f}};

constexpr Logistic<kCharacterEvidence.size()> kCharacterFit{-5.0640f, {6.0897f, 5.6463f, 0.93148f}};

// Below this confidence a rig should not be used unseen.
constexpr float kLowConfidence = 0.060f;

}  // namespace osteon::pipelines
