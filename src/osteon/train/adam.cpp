// SPDX-License-Identifier: Apache-2.0
#include "osteon/train/adam.h"

#include <ATen/core/grad_mode.h>

#include <cmath>
#include <string_view>
#include <vector>

#include "osteon/base/error.h"

namespace osteon::train {
namespace {

constexpr std::string_view first_prefix = "adam/first/", second_prefix = "adam/second/";

// What is trained, parallel arrays: operations on whole lists are few kernels on a GPU.
struct Trained {
  std::vector<std::string> names;
  std::vector<at::Tensor> values, gradients, matrices;  // matrices: those of the values
};

Trained with_gradient(Model& model) {
  Trained all;
  for (auto& [part, parameters] : model.parts)
    for (auto& [name, value] : parameters) {
      if (!value.grad().defined()) continue;
      all.names.push_back(part + '/' + name);
      all.values.push_back(value);
      all.gradients.push_back(value.grad());
      if (value.dim() == 2) all.matrices.push_back(value);
    }
  return all;
}

double norm_of(const std::vector<at::Tensor>& gradients) {
  return at::stack(at::_foreach_norm(gradients)).to(at::kDouble).norm().item<double>();
}

}  // namespace

double Adam::step(Model& model, double learning_rate) {
  const at::NoGradGuard no_grad;
  Trained all = with_gradient(model);
  const double norm = norm_of(all.gradients);
  if (std::isfinite(norm)) {
    const double clip = options_.largest_norm > 0.0 && norm > options_.largest_norm ? options_.largest_norm / norm : 1.0;
    ++steps_;
    const double correction1 = 1.0 - std::pow(options_.beta1, static_cast<double>(steps_));
    const double correction2 = std::sqrt(1.0 - std::pow(options_.beta2, static_cast<double>(steps_)));
    std::vector<at::Tensor> first, second;
    for (std::size_t i = 0; i < all.names.size(); ++i) {
      Moments& m = moments_[all.names[i]];
      if (!m.first.defined()) m = {at::zeros_like(all.values[i]), at::zeros_like(all.values[i])};
      first.push_back(m.first);
      second.push_back(m.second);
    }
    if (clip != 1.0) at::_foreach_mul_(all.gradients, clip);
    at::_foreach_mul_(first, options_.beta1);
    at::_foreach_add_(first, all.gradients, 1.0 - options_.beta1);
    at::_foreach_mul_(second, options_.beta2);
    at::_foreach_addcmul_(second, all.gradients, all.gradients, 1.0 - options_.beta2);
    at::_foreach_mul_(all.matrices, 1.0 - learning_rate * options_.weight_decay);
    std::vector<at::Tensor> spread = at::_foreach_sqrt(second);
    at::_foreach_div_(spread, correction2);
    at::_foreach_add_(spread, options_.epsilon);
    at::_foreach_addcdiv_(all.values, first, spread, -learning_rate / correction1);
  }
  for (at::Tensor& value : all.values) value.mutable_grad() = at::Tensor();
  return norm;
}

void Adam::save(Safetensors& file) const {
  file.metadata["adam_steps"] = std::to_string(steps_);
  for (const auto& [name, m] : moments_) {
    file.arrays[std::string(first_prefix) + name] = to_array(m.first);
    file.arrays[std::string(second_prefix) + name] = to_array(m.second);
  }
}

void Adam::load(const Safetensors& file, at::Device device) {
  steps_ = std::stoll(file.metadata.at("adam_steps"));
  for (const auto& [name, array] : file.arrays) {
    if (!name.starts_with(first_prefix)) continue;
    const std::string parameter = name.substr(first_prefix.size());
    moments_[parameter] = {from_array(array).to(device), from_array(file.at(std::string(second_prefix) + parameter)).to(device)};
  }
}

}  // namespace osteon::train
