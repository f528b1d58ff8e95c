// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ATen/ATen.h>

#include <cstdint>
#include <functional>
#include <vector>

#include "osteon/train/norm_rule.h"

// Shared parts of the layers that are written by hand for the CPU. Sums are made over a fixed number of row groups and then group by
// group, so results do not depend on the number of threads.
namespace osteon::train {

constexpr int row_groups = 16;

// Calls body(group, first, last) for `row_groups` consecutive ranges of 0..rows-1, on all of ATen's threads.
void for_row_groups(std::int64_t rows, const std::function<void(int group, std::int64_t first, std::int64_t last)>& body);

// One vector of floats for each row group, added up in the order of the groups.
class GroupSums {
 public:
  explicit GroupSums(std::int64_t width) : width_(width), values_(static_cast<std::size_t>(row_groups * width), 0.0f) {}
  float* of(int group) { return values_.data() + group * width_; }
  std::vector<double> total() const;

 private:
  std::int64_t width_;
  std::vector<float> values_;
};

// Batch normalisation y = scale x + shift as it stands for one batch (or for use), per column:
// y = weight ((x - mean) inverse_deviation stretch + offset) + bias.
struct Norm {
  std::vector<double> mean, inverse_deviation;
  std::vector<double> stretch, offset;  // 1 and 0 but for batch renormalisation; constants for the gradient
  std::vector<float> scale, shift;
};

// The parameters of a normalisation, each (C); running figures are updated in training.
struct NormParameters {
  at::Tensor weight, bias, running_mean, running_var;
};

// Training: normalises with the figures of the batch, corrected by `rule`, and updates the running ones.
Norm batch_norm_of(const GroupSums& sum, const GroupSums& squares, std::int64_t rows, const NormParameters& parameters,
                   const NormRule& rule);
Norm stored_norm_of(const NormParameters& parameters);

// dL/dx = scale * dL/dy - constant - slope * x, where x is normalised with figures of the batch itself.
struct NormGradient {
  std::vector<float> constant, slope;
  at::Tensor weight, bias;  // gradients of the parameters
};

// From the sums of dL/dy and of dL/dy * x over `rows` rows.
NormGradient norm_gradient(const Norm& norm, const std::vector<double>& sum, const std::vector<double>& product, std::int64_t rows);

at::Tensor to_tensor(const std::vector<double>& values);

}  // namespace osteon::train
