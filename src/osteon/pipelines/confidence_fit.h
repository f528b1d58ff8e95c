// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/pipelines/confidence.h"

// Written by scripts/calibrate for the networks in models/rignet; run it again when they, or how joints are found, change.
namespace osteon::pipelines {

constexpr Logistic<kJointEvidence.size()> kJointFit{0.27896f, {-0.025102f, 3.3198f, 0.32369f}};

constexpr Logistic<kCharacterEvidence.size()> kCharacterFit{-4.9383f, {5.7187f, 4.7129f, 0.71073f}};

// Below this confidence a rig should not be used unseen.
constexpr float kLowConfidence = 0.138f;

}  // namespace osteon::pipelines
