// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/pipelines/confidence.h"

// Written by scripts/calibrate for the networks in models/rignet; run it again when they, or how joints are found, change.
namespace osteon::pipelines {

constexpr Logistic<kJointEvidence.size()> kJointFit{0.68913f, {0.097546f, 2.8816f, 0.34003f}};

constexpr Logistic<kCharacterEvidence.size()> kCharacterFit{-5.3705f, {7.7094f, 3.5831f, 0.73447f}};

// Below this confidence a rig should not be used unseen.
constexpr float kLowConfidence = 0.031f;

}  // namespace osteon::pipelines
