// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ATen/ATen.h>

#include "osteon/train/norm.h"

// What an edge convolution does per edge, in one pass over tiles that stay in the cache, with its gradient:
//   h = norm1(relu(receiver term + source term));  y = norm2(relu(W h + b));  out = max over the receiver's edges of y
// The ReLU of the second layer and its normalisation move behind the maximum (both are monotone); statistics stay those of all edges.
namespace osteon::train {

struct EdgeLayerParameters {
  at::Tensor weight, bias;  // (H,H), (H)
  NormParameters norm1, norm2;
};

// Directed edges sorted by receiver, 32-bit: see nets::Edges.
struct EdgeIndices {
  at::Tensor offsets, sources;
};

// What the gradient needs of the forward pass. The backward pass uses up `r`.
struct EdgeLayerMemory {
  at::Tensor terms;  // (V,2H)
  at::Tensor r;      // (E,H) relu(W h + b)
  at::Tensor best;   // (V,H) of these, the one that each receiver took
  at::Tensor arg;    // (V,H) its edge
  Norm norm1, norm2;
};

struct EdgeLayerGradients {
  at::Tensor terms, weight, bias, norm1_weight, norm1_bias, norm2_weight, norm2_bias;
};

// terms (V,2H): receiver terms (bias included), then source terms. Normalises with the figures of the batch, updates the running ones.
at::Tensor edge_layer_train(const at::Tensor& terms, const EdgeIndices& edges, const EdgeLayerParameters& parameters, const NormRule& rule,
                            EdgeLayerMemory& memory);
EdgeLayerGradients edge_layer_backward(const at::Tensor& gradient, const EdgeIndices& edges, const EdgeLayerParameters& parameters,
                                       EdgeLayerMemory& memory);
// With the running figures.
at::Tensor edge_layer_use(const at::Tensor& terms, const EdgeIndices& edges, const EdgeLayerParameters& parameters);

}  // namespace osteon::train
