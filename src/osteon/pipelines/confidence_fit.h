// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/pipelines/confidence.h"

// Written by scripts/calibrate for the networks in models/rignet; run it again when they, or how joints are found, change.
namespace osteon::pipelines {

constexpr Logistic<kJointEvidence.size()> kJointFit{-0.098710f, {0.080500f, 3.2740f, 0.28887f}};

constexpr Logistic<kCharacterEvidence.size()> kCharacterFit{7.8793f, {3.0980f, -3.1484f, 2.1162f}};

// Below this confidence a rig should not be used unseen.
constexpr float kLowConfidence = 0.026f;

}  // namespace osteon::pipelines
