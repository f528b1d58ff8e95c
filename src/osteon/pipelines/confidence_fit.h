// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/pipelines/confidence.h"

// Written by scripts/calibrate for the networks in models/rignet; run it again when they, or how joints are found, change.
namespace osteon::pipelines {

constexpr Logistic<kJointEvidence.size()> kJointFit{0.68913f, {0.097546f, 2.8816f, 0.34003f}};

constexpr Logistic<kCharacterEvidence.size()> kCharacterFit{0.47221f, {7.5413f, -1.8280f, 1.2792f}};

// Below this confidence a rig should not be used unseen.
constexpr float kLowConfidence = 0.028f;

}  // namespace osteon::pipelines
