// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "osteon/infer/parameters.h"
#include "osteon/tensor/edge_convolution.h"
#include "osteon/tensor/packed_mlp.h"

// At use a batch normalisation is y = scale * x + shift per column. Ours comes after the ReLU, so it cannot go into the layer before it; it
// goes into every linear layer that reads the result: W (s*x + t) + b = (W diag(s)) x + (b + W t). No normalisation is left to compute.
namespace osteon::infer {

struct Affine {
  std::vector<float> scale, shift;  // by column
};

// weight (x - mean) / sqrt(var + norm_epsilon) + bias, from the running figures at `path`.
Affine normalization(const Parameters& parameters, const nets::Path& path);

// The linear layer at `path` for input to which `input` is still to be applied.
tensor::DenseLayer folded_linear(const Parameters& parameters, const nets::Path& path, const Affine& input, tensor::Activation activation,
                                 tensor::Precision precision);

// The edge convolution MLP[2C, H, H] at `path` without its last normalisation (which only gives the signs); see tensor::EdgeConvolution.
tensor::EdgeConvolution::Weights folded_edge_convolution(const Parameters& parameters, const nets::Path& path, const Affine& input,
                                                         tensor::Precision precision);

}  // namespace osteon::infer
