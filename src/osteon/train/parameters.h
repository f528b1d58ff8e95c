// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ATen/ATen.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace osteon::train {

// The parameters and running figures of a network by path, in alphabetical order. (torch::nn::Module refuses names with a dot.)
using Parameters = std::map<std::string, at::Tensor>;

// Running figures of normalisations are kept up to date by the forward pass; all else is trained.
bool is_trained(const std::string& name);

// As PyTorch initialises: weights and biases of linear layers uniform in +-1/sqrt(inputs), normalisations 1 and 0. Each parameter's values
// depend on `seed` and its own name only.
Parameters initial_parameters(const std::map<std::string, std::vector<std::int64_t>>& shapes, std::uint64_t seed);

// Moves all to `device` and makes the trained ones leaves that collect gradients.
void prepare_for_training(Parameters& parameters, at::Device device);

}  // namespace osteon::train
