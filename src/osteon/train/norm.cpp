// SPDX-License-Identifier: Apache-2.0
#include "osteon/train/norm.h"

#include <ATen/Parallel.h>

#include <algorithm>
#include <cmath>

namespace osteon::train {
namespace {

Norm with_affine(std::vector<double> mean, std::vector<double> inverse_deviation, const NormParameters& parameters) {
  Norm norm{std::move(mean), std::move(inverse_deviation), {}, {}};
  const float* weight = parameters.weight.data_ptr<float>();
  const float* bias = parameters.bias.data_ptr<float>();
  for (std::size_t c = 0; c < norm.mean.size(); ++c) {
    const double scale = weight[c] * norm.inverse_deviation[c];
    norm.scale.push_back(static_cast<float>(scale));
    norm.shift.push_back(static_cast<float>(bias[c] - scale * norm.mean[c]));
  }
  return norm;
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

Norm batch_norm_of(const GroupSums& sum, const GroupSums& squares, std::int64_t rows, const NormParameters& parameters, double momentum) {
  std::vector<double> mean = sum.total(), deviation = squares.total();
  float* running_mean = parameters.running_mean.data_ptr<float>();
  float* running_var = parameters.running_var.data_ptr<float>();
  const auto n = static_cast<double>(rows);
  for (std::size_t c = 0; c < mean.size(); ++c) {
    mean[c] /= n;
    const double variance = std::max(0.0, deviation[c] / n - mean[c] * mean[c]);
    const double unbiased = rows > 1 ? variance * n / (n - 1.0) : variance;
    running_mean[c] = static_cast<float>((1.0 - momentum) * running_mean[c] + momentum * mean[c]);
    running_var[c] = static_cast<float>((1.0 - momentum) * running_var[c] + momentum * unbiased);
    deviation[c] = 1.0 / std::sqrt(variance + norm_epsilon);
  }
  return with_affine(std::move(mean), std::move(deviation), parameters);
}

Norm stored_norm_of(const NormParameters& parameters) {
  std::vector<double> mean, inverse_deviation;
  for (std::int64_t c = 0; c < parameters.weight.size(0); ++c) {
    mean.push_back(parameters.running_mean.data_ptr<float>()[c]);
    inverse_deviation.push_back(1.0 / std::sqrt(parameters.running_var.data_ptr<float>()[c] + norm_epsilon));
  }
  return with_affine(std::move(mean), std::move(inverse_deviation), parameters);
}

NormGradient norm_gradient(const Norm& norm, const std::vector<double>& sum, const std::vector<double>& product, std::int64_t rows) {
  NormGradient gradient;
  std::vector<double> weight(sum.size());
  const auto n = static_cast<double>(rows);
  for (std::size_t c = 0; c < sum.size(); ++c) {
    weight[c] = norm.inverse_deviation[c] * (product[c] - norm.mean[c] * sum[c]);
    const double slope = norm.scale[c] * norm.inverse_deviation[c] * weight[c] / n;
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
