// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "osteon/tensor/packed_linear.h"
#include "osteon/tensor/packed_mlp.h"
#include "osteon/tensor/tensor.h"

namespace osteon::tensor {

// Directed edges sorted by receiver: those into vertex v are offsets[v] .. offsets[v+1]-1, never none (a self loop at least).
struct EdgeList {
  std::span<const std::int32_t> offsets;    // (V+1)
  std::span<const std::int32_t> sources;    // (E)
  std::span<const std::int32_t> receivers;  // (E)
};

// y_v = max(0, sign * max over the edges u -> v of W max(0, P x_v + Q x_u + b) + shift), column by column.
//
// The edge convolution of Wang et al. (Dynamic Graph CNN, TOG 2019, section 3.1) with MLP[2C, H, H]([x_v, x_u - x_v]), where
// everything that needs no edge has left it: [A|B] [x_v; x_u - x_v] = (A - B) x_v + B x_u is two products a vertex, and a monotone function
// (bias, ReLU, normalisation) of all messages may wait until after their maximum. A normalisation that falls needs the minimum
// instead: with the row of W negated (sign -1) that is again a maximum. Exact but for rounding.
// The messages exist for a tile at a time only.
class EdgeConvolution {
 public:
  struct Weights {
    DenseLayer ends;                 // (2H, C): P above Q; no activation; its precision is that of all products
    Matrix messages;                 // (H, H): W
    std::vector<float> sign, shift;  // (H)
  };
  explicit EdgeConvolution(Weights weights);

  Tensor operator()(const Tensor& x, const EdgeList& edges) const;  // (V,C) -> (V,H)

 private:
  void run_vertices(const Tensor& ends, const EdgeList& edges, std::size_t begin, std::size_t end, float* out) const;

  PackedMlp ends_;
  PackedLinear messages_;
  std::vector<float> sign_, shift_;
};

}  // namespace osteon::tensor
