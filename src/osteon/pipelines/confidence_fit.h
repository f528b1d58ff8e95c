// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/pipelines/confidence.h"

// Written by scripts/calibrate for the networks in models/rignet; run it again when they, or how joints are found, change.
namespace osteon::pipelines {

constexpr Logistic<kJointEvidence.size()> kJointFit{0.26737f, {0.0000f, 2.7593f, 0.24793f}};

constexpr Logistic<kCharacterEvidence.size()> kCharacterFit{-5.0641f, {6.0914f, 5.6336f, 0.92878f}};

// Below this confidence a rig should not be used unseen.
constexpr float kLowConfidence = 0.060f;

}  // namespace osteon::pipelines
