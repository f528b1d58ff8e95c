// SPDX-License-Identifier: Apache-2.0
#include "osteon/train/adam.h"

#include <cmath>
#include <string_view>
#include <vector>

#include "osteon/base/error.h"

namespace osteon::train {
namespace {

constexpr std::string_view first_prefix = "adam/first/", second_prefix = "adam/second/";

struct Named {
  std::string name;
  at::Tensor value, gradient;
};

std::vector<Named> with_gradient(Model& model) {
  std::vector<Named> all;
  for (auto& [part, parameters] : model.parts)
    for (auto& [name, value] : parameters)
      if (value.grad().defined()) all.push_back({part + '/' + name, value, value.grad()});
  return all;
}

double norm_of(const std::vector<Named>& parameters) {
  double squares = 0.0;
  for (const Named& p : parameters) {
    const double norm = p.gradient.norm().item<double>();
    squares += norm * norm;
  }
  return std::sqrt(squares);
}

}  // namespace

double Adam::step(Model& model, double learning_rate) {
  const at::NoGradGuard no_grad;
  std::vector<Named> parameters = with_gradient(model);
  const double norm = norm_of(parameters);
  if (std::isfinite(norm)) {
    const double clip = options_.largest_norm > 0.0 && norm > options_.largest_norm ? options_.largest_norm / norm : 1.0;
    ++steps_;
    const double correction1 = 1.0 - std::pow(options_.beta1, static_cast<double>(steps_));
    const double correction2 = std::sqrt(1.0 - std::pow(options_.beta2, static_cast<double>(steps_)));
    for (Named& p : parameters) {
      Moments& m = moments_[p.name];
      if (!m.first.defined()) m = {at::zeros_like(p.value), at::zeros_like(p.value)};
      if (clip != 1.0) p.gradient.mul_(clip);
      m.first.mul_(options_.beta1).add_(p.gradient, 1.0 - options_.beta1);
      m.second.mul_(options_.beta2).addcmul_(p.gradient, p.gradient, 1.0 - options_.beta2);
      if (p.value.dim() == 2) p.value.mul_(1.0 - learning_rate * options_.weight_decay);
      p.value.addcdiv_(m.first, (m.second.sqrt() / correction2).add_(options_.epsilon), -learning_rate / correction1);
    }
  }
  for (Named& p : parameters) p.value.mutable_grad() = at::Tensor();
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
