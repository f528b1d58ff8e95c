// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/dataset/batch.h"

// What the NeuroSkinning networks learn from.
namespace osteon::dataset {

// Fills the example's bone choices, wide balls and skin targets. Pre: parts are neuro or neuro_2019.
void derive_neuro(Example& example, const PreparedCharacter& character, Parts parts);

// Appends the character, placed, to the inputs and targets of the batch; its mesh was added last. `named`: whether joints' names are read.
// Pre: options.super_skeleton is there.
void add_neuro(Batch& batch, const Example& example, const Placement& placement, const BatchOptions& options, bool named);

}  // namespace osteon::dataset
