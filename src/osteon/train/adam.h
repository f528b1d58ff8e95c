// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "osteon/base/safetensors.h"
#include "osteon/train/model.h"

namespace osteon::train {

struct AdamOptions {
  double beta1 = 0.9, beta2 = 0.999, epsilon = 1e-8;
  double weight_decay = 0.01;  // decoupled, on matrices only: not on biases, normalisations nor the bandwidth
  double largest_norm = 1.0;   // gradients are scaled down to this norm over all parameters; 0: never
};

// Loshchilov and Hutter, Decoupled Weight Decay Regularization, ICLR 2019.
class Adam {
 public:
  explicit Adam(const AdamOptions& options) : options_(options) {}

  // Moves every trained parameter that has a gradient, and clears the gradients. Returns their norm before clipping. When it is not
  // finite nothing moves.
  double step(Model& model, double learning_rate);

  void save(Safetensors& file) const;  // arrays "adam/first/<name>", "adam/second/<name>"; metadata "adam_steps"
  void load(const Safetensors& file, at::Device device);

 private:
  struct Moments {
    at::Tensor first, second;
  };
  AdamOptions options_;
  std::int64_t steps_ = 0;
  std::map<std::string, Moments> moments_;
};

}  // namespace osteon::train
