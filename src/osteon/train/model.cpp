// SPDX-License-Identifier: Apache-2.0
#include "osteon/train/model.h"

#include <span>
#include <vector>

#include "osteon/base/error.h"

namespace osteon::train {
namespace {

std::vector<float> values_of(const at::Tensor& tensor) {
  const at::Tensor flat = tensor.detach().to(at::kCPU, at::kFloat).contiguous();
  return {flat.data_ptr<float>(), flat.data_ptr<float>() + flat.numel()};
}

std::string shape_text(const std::vector<std::int64_t>& shape) { return fmt::format("[{}]", fmt::join(shape, ",")); }

}  // namespace

std::uint64_t count_of_trained(const Model& model) {
  std::uint64_t count = 0;
  for (const auto& [part, parameters] : model.parts)
    for (const auto& [name, value] : parameters)
      if (is_trained(name)) count += static_cast<std::uint64_t>(value.numel());
  return count;
}

Array to_array(const at::Tensor& values) { return Array::of<float>(values_of(values), values.sizes().vec()); }

at::Tensor from_array(const Array& array) {
  const std::vector<float> values = array.values<float>();
  at::Tensor tensor = at::empty(array.shape, at::kFloat);
  std::copy(values.begin(), values.end(), tensor.data_ptr<float>());
  return tensor;
}

void save_weights(const std::filesystem::path& path, const Parameters& parameters, const std::map<std::string, std::string>& metadata) {
  Safetensors file;
  file.metadata = metadata;
  for (const auto& [name, value] : parameters) {
    if (!value.isfinite().all().item<bool>())
      throw Error("{}: not written: {} is no longer finite; try a smaller learning rate", path.string(), name);
    file.arrays[name] = value.dim() == 2 ? Array::half(values_of(value), value.sizes().vec()) : to_array(value);
  }
  save_safetensors(path, file);
}

Parameters load_weights(const std::filesystem::path& path, nets::rignet::Network network) {
  const Safetensors file = load_safetensors(path);
  const auto shapes = nets::rignet::parameter_shapes(network);
  Parameters parameters;
  std::vector<std::string> differences;
  for (const auto& [name, shape] : shapes) {
    const auto found = file.arrays.find(name);
    if (found == file.arrays.end())
      differences.push_back("no " + name);
    else if (found->second.shape != shape)
      differences.push_back(fmt::format("{} is {}, expected {}", name, shape_text(found->second.shape), shape_text(shape)));
    else
      parameters[name] = from_array(found->second);
  }
  for (const auto& [name, array] : file.arrays)
    if (!shapes.contains(name)) differences.push_back("unknown " + name);
  if (!differences.empty())
    throw Error("{}: not weights of the {} network: {}", path.string(), nets::rignet::name_of(network), fmt::join(differences, "; "));
  return parameters;
}

skin::SuperSkeleton load_super_skeleton(const std::filesystem::path& path) {
  const auto metadata = load_safetensors(path).metadata;
  const auto found = metadata.find("super_skeleton");
  if (found == metadata.end()) throw Error("{}: has no super skeleton in its metadata", path.string());
  return skin::SuperSkeleton::from_json(found->second);
}

}  // namespace osteon::train
