// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/pipelines/confidence.h"

// Written by scripts/calibrate for the networks in models/rignet; run it again when they, or how joints are found, change.
namespace osteon::pipelines {

constexpr Logistic<kJointEvidence.size()> kJointFit{0.33892f, {0.0000f, 2.8926f, 0.27443f}};

constexpr Logistic<kCharacterEvidence.size()> kCharacterFit{-5.2434f, {6.1447f, 5.6818f, 0.89419f}};

// Below this confidence a rig should not be used unseen.
constexpr float kLowConfidence = 0.061f;

}  // namespace osteon::pipelines
