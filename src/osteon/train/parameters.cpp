// SPDX-License-Identifier: Apache-2.0
#include "osteon/train/parameters.h"

#include <cmath>

#include "osteon/base/random.h"

namespace osteon::train {
namespace {

bool ends_with(const std::string& name, const char* end) { return name.ends_with(end); }

std::uint64_t hash(const std::string& text) {  // FNV-1a
  std::uint64_t h = 14695981039346656037u;
  for (const unsigned char c : text) h = (h ^ c) * 1099511628211u;
  return h;
}

// The number of inputs of the linear layer that `name` belongs to; 0 when it is of a normalisation.
std::int64_t fan_in(const std::string& name, const std::map<std::string, std::vector<std::int64_t>>& shapes) {
  const std::string layer = name.substr(0, name.rfind('.'));
  const auto weight = shapes.find(layer + ".weight");
  return weight != shapes.end() && weight->second.size() == 2 ? weight->second[1] : 0;
}

}  // namespace

bool is_trained(const std::string& name) { return !ends_with(name, ".running_mean") && !ends_with(name, ".running_var"); }

Parameters initial_parameters(const std::map<std::string, std::vector<std::int64_t>>& shapes, std::uint64_t seed) {
  Parameters parameters;
  for (const auto& [name, shape] : shapes) {
    const std::int64_t inputs = fan_in(name, shapes);
    at::Tensor values;
    if (inputs > 0) {
      values = at::empty(shape, at::kFloat);
      Random random = Random(seed).fork(hash(name));
      const float bound = 1.0f / std::sqrt(static_cast<float>(inputs));
      for (std::int64_t i = 0; i < values.numel(); ++i) values.data_ptr<float>()[i] = random.uniform(-bound, bound);
    } else {
      const bool ones = ends_with(name, ".weight") || ends_with(name, ".running_var");
      values = ones ? at::ones(shape, at::kFloat) : at::zeros(shape, at::kFloat);
    }
    parameters[name] = values;
  }
  return parameters;
}

void prepare_for_training(Parameters& parameters, at::Device device) {
  for (auto& [name, value] : parameters) {
    value = value.detach().to(device, at::kFloat).contiguous().clone();
    value.set_requires_grad(is_trained(name));
  }
}

}  // namespace osteon::train
