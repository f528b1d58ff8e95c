// SPDX-License-Identifier: Apache-2.0
#include "osteon/infer/parameters.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>

#include "osteon/base/error.h"

namespace osteon::infer {
namespace {

std::string text(const std::vector<std::int64_t>& shape) { return fmt::format("({})", fmt::join(shape, ",")); }

Matrix as_matrix(const Array& array) {
  const auto rows = array.shape.size() > 1 ? array.shape[0] : 1;
  const std::vector<float> values = array.values<float>();
  return Eigen::Map<const Matrix>(values.data(), rows, rows == 0 ? 0 : array.count() / rows);
}

// What is wrong with a tensor that the network and the file both have; empty if nothing.
std::string fault_of(const std::string& name, const Array& found, const std::vector<std::int64_t>& shape) {
  if (found.shape != shape) return fmt::format("{}: shape {}, expected {}", name, text(found.shape), text(shape));
  if (found.dtype != DType::f32 && found.dtype != DType::f16) return fmt::format("{}: neither float32 nor float16", name);
  const Matrix values = as_matrix(found);
  if (!values.allFinite()) return fmt::format("{}: has values that are not finite", name);
  if (name.ends_with("running_var") && values.minCoeff() < 0) return fmt::format("{}: has negative variances", name);
  return {};
}

std::vector<std::string> differences(const Safetensors& content, const Shapes& expected) {
  std::vector<std::string> out;
  for (const auto& [name, shape] : expected) {
    const auto found = content.arrays.find(name);
    if (found == content.arrays.end())
      out.push_back(fmt::format("{}: missing, expected {}", name, text(shape)));
    else if (std::string fault = fault_of(name, found->second, shape); !fault.empty())
      out.push_back(std::move(fault));
  }
  for (const auto& [name, array] : content.arrays)
    if (!expected.contains(name)) out.push_back(fmt::format("{}: {} is no parameter of this network", name, text(array.shape)));
  return out;
}

}  // namespace

Parameters::Parameters(const Safetensors& content, const Shapes& expected, std::string_view source) {
  if (const auto wrong = differences(content, expected); !wrong.empty())
    throw Error("{}: {} of {} parameters do not fit the network:\n  {}", source, wrong.size(), expected.size(), fmt::join(wrong, "\n  "));
  for (const auto& [name, shape] : expected) matrices_.emplace(name, as_matrix(content.at(name)));
}

const Matrix& Parameters::at(const nets::Path& name) const {
  const auto found = matrices_.find(name.name());
  assert(found != matrices_.end());
  return found->second;
}

void Parameters::forget(const nets::Path& layer) {
  std::erase_if(matrices_, [prefix = layer.name() + '.'](const auto& entry) { return entry.first.starts_with(prefix); });
}

Parameters load_parameters(const std::filesystem::path& file, const Shapes& expected) {
  return {load_safetensors(file), expected, file.string()};
}

}  // namespace osteon::infer
