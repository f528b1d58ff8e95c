// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/pipelines/confidence.h"

// Written by scripts/calibrate for the networks in models/rignet; run it again when they, or how joints are found, change.
namespace osteon::pipelines {

constexpr Logistic<kJointEvidence.size()> kJointFit{0.39292f, {0.034829f, 2.8885f, 0.25431f}};

constexpr Logistic<kCharacterEvidence.size()> kCharacterFit{-6.1667f, {6.7916f, 5.0470f, 0.61962f}};

// Below this confidence a rig should not be used unseen.
constexpr float kLowConfidence = 0.055f;

}  // namespace osteon::pipelines
