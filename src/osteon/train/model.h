// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include "osteon/base/safetensors.h"
#include "osteon/nets/dry_run.h"
#include "osteon/skin/super_skeleton.h"
#include "osteon/train/parameters.h"

namespace osteon::train {

// What is trained together, in one map: each parameter's name is "<network>/<path>", such as "joints/gcu1.ring.0.linear.weight".
struct Model {
  std::map<std::string, Parameters> parts;  // by network: joints, attention, votes, bones, root, skin; and "bandwidth", with one value "h"

  Parameters& operator[](const std::string& part) { return parts[part]; }
};

std::uint64_t count_of_trained(const Model& model);

Array to_array(const at::Tensor& values);   // f32
at::Tensor from_array(const Array& array);  // f32 or f16 -> f32

// Weights as the program uses them: matrices in f16, the rest (biases, normalisations) in f32. Throws Error where one is
// not finite: the training went astray, and what was there before is worth more.
void save_weights(const std::filesystem::path& path, const Parameters& parameters, const std::map<std::string, std::string>& metadata);

// Throws Error that lists every name and shape in which the file and the network differ.
Parameters load_weights(const std::filesystem::path& path, nets::rignet::Network network);

// What NeuroSkinning's weights read joints by. Throws Error where the file's metadata have none.
skin::SuperSkeleton load_super_skeleton(const std::filesystem::path& path);

}  // namespace osteon::train
