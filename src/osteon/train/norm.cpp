// SPDX-License-Identifier: Apache-2.0
#include "osteon/train/norm.h"

#include <ATen/Parallel.h>

#include <algorithm>
#include <cmath>

#include "osteon/nets/ops.h"

namespace osteon::train {
namespace {

void add_affine(Norm& norm, const NormParameters& parameters) {
  const float* weight = parameters.weight.data_ptr<float>();
  const float* bias = parameters.bias.data_ptr<float>();
  for (std::size_t c = 0; c < norm.mean.size(); ++c) {
    const double scale = weight[c] * norm.inverse_deviation[c] * norm.stretch[c];
    norm.scale.push_back(static_cast<float>(scale));
    norm.shift.push_back(static_cast<float>(bias[c] + weight[c] * norm.offset[c] - scale * norm.mean[c]));
  }
}

}  // namespace

void for_row_groups(std::int64_t rows, const std::function<void(int group, std::int64_t first, std::int64_t last)>& body) {
  at::parallel_for(0, row_groups, 1, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t group = begin; group < end; ++group)
      body(static_cast<int>(group), rows * group / row_groups, rows * (group + 1) / row_groups);
  });
}

std::vector<double> GroupSums::total() const {
  std::vector<double> sum(static_cast<std::size_t>(width_), 0.0);
  for (int group = 0; group < row_groups; ++group)
    for (std::int64_t c = 0; c < width_; ++c) sum[c] += values_[group * width_ + c];
  return sum;
}

Norm batch_norm_of(const GroupSums& sum, const GroupSums& squares, std::int64_t rows, const NormParameters& parameters,
                   const NormRule& rule) {
  const std::vector<double> sums = sum.total(), square_sums = squares.total();
  Norm norm;
  float* running_mean = parameters.running_mean.data_ptr<float>();
  float* running_var = parameters.running_var.data_ptr<float>();
  const auto n = static_cast<double>(rows);
  for (std::size_t c = 0; c < sums.size(); ++c) {
    const double mean = sums[c] / n, variance = std::max(0.0, square_sums[c] / n - mean * mean);
    const double deviation = std::sqrt(variance + nets::norm_epsilon), usual = std::sqrt(running_var[c] + nets::norm_epsilon);
    norm.mean.push_back(mean);
    norm.inverse_deviation.push_back(1.0 / deviation);
    norm.stretch.push_back(std::clamp(deviation / usual, 1.0 / rule.largest_stretch, rule.largest_stretch));
    norm.offset.push_back(std::clamp((mean - running_mean[c]) / usual, -rule.largest_offset, rule.largest_offset));
    const double unbiased = rows > 1 ? variance * n / (n - 1.0) : variance;
    running_mean[c] = static_cast<float>((1.0 - rule.momentum) * running_mean[c] + rule.momentum * mean);
    running_var[c] = static_cast<float>((1.0 - rule.momentum) * running_var[c] + rule.momentum * unbiased);
  }
  add_affine(norm, parameters);
  return norm;
}

Norm stored_norm_of(const NormParameters& parameters) {
  Norm norm;
  for (std::int64_t c = 0; c < parameters.weight.size(0); ++c) {
    norm.mean.push_back(parameters.running_mean.data_ptr<float>()[c]);
    norm.inverse_deviation.push_back(1.0 / std::sqrt(parameters.running_var.data_ptr<float>()[c] + nets::norm_epsilon));
  }
  norm.stretch.assign(norm.mean.size(), 1.0);
  norm.offset.assign(norm.mean.size(), 0.0);
  add_affine(norm, parameters);
  return norm;
}

NormGradient norm_gradient(const Norm& norm, const std::vector<double>& sum, const std::vector<double>& product, std::int64_t rows) {
  NormGradient gradient;
  std::vector<double> weight(sum.size());
  const auto n = static_cast<double>(rows);
  for (std::size_t c = 0; c < sum.size(); ++c) {
    const double along = norm.inverse_deviation[c] * (product[c] - norm.mean[c] * sum[c]);  // sum of dL/dy times the standardised x
    weight[c] = norm.stretch[c] * along + norm.offset[c] * sum[c];
    const double slope = norm.scale[c] * norm.inverse_deviation[c] * along / n;
    gradient.slope.push_back(static_cast<float>(slope));
    gradient.constant.push_back(static_cast<float>(norm.scale[c] * sum[c] / n - slope * norm.mean[c]));
  }
  gradient.weight = to_tensor(weight);
  gradient.bias = to_tensor(sum);
  return gradient;
}

at::Tensor to_tensor(const std::vector<double>& values) {
  at::Tensor tensor = at::empty({static_cast<std::int64_t>(values.size())}, at::kFloat);
  std::transform(values.begin(), values.end(), tensor.data_ptr<float>(), [](double x) { return static_cast<float>(x); });
  return tensor;
}

}  // namespace osteon::train
