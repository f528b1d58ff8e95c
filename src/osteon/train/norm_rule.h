// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace osteon::train {

// How a normalisation treats a batch in training. Batch renormalisation: Ioffe, Batch Renormalization: Towards Reducing Minibatch
// Dependence in Batch-Normalized Models, NeurIPS 2017. With batches of two meshes plain batch normalisation tells the network how a mesh
// differs from the other one, which use cannot; renormalised values are those of use, and only the gradient sees the batch.
struct NormRule {
  double momentum = 0.1;         // running = (1 - momentum) running + momentum batch, with the unbiased variance
  double largest_stretch = 1.0;  // deviation(batch) / deviation(running) is corrected up to this factor (Ioffe's r); 1: not at all
  double largest_offset = 0.0;   // (mean(batch) - mean(running)) / deviation(running) up to this (Ioffe's d); 0: not at all

  bool renormalises() const { return largest_stretch > 1.0 || largest_offset > 0.0; }
};

}  // namespace osteon::train
