// SPDX-License-Identifier: Apache-2.0
#include "osteon/infer/parameters.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>

#include "osteon/base/error.h"

namespace osteon::infer {
namespace {

std::string text(const std::vector<std::int64_t>& shape) { return fmt::format("({})", fmt::join(shape, ",")); }

bool has_floats(const Array& array) { return array.dtype == DType::f32 || array.dtype == DType::f16; }

Matrix as_matrix(const Array& array) {
  const auto rows = array.shape.size() > 1 ? array.shape[0] : 1;
  const std::vector<float> values = array.values<float>();
  return Eigen::Map<const Matrix>(values.data(), rows, rows == 0 ? 0 : array.count() / rows);
}

// What is wrong with the values of a parameter; empty if nothing.
std::string fault_of(const std::string& name, const Matrix& values) {
  if (!values.allFinite()) return fmt::format("{}: has values that are not finite", name);
  if (name.ends_with("running_var") && values.minCoeff() < 0) return fmt::format("{}: has negative variances", name);
  return {};
}

}  // namespace

Parameters::Parameters(const Safetensors& content, const Shapes& expected, std::string_view source) {
  std::vector<std::string> wrong;
  for (const auto& [name, shape] : expected) {
    const auto found = content.arrays.find(name);
    if (found == content.arrays.end()) {
      wrong.push_back(fmt::format("{}: missing, expected {}", name, text(shape)));
    } else if (found->second.shape != shape) {
      wrong.push_back(fmt::format("{}: shape {}, expected {}", name, text(found->second.shape), text(shape)));
    } else if (!has_floats(found->second)) {
      wrong.push_back(fmt::format("{}: neither float32 nor float16", name));
    } else {
      const Matrix& values = matrices_.emplace(name, as_matrix(found->second)).first->second;
      if (std::string fault = fault_of(name, values); !fault.empty()) wrong.push_back(std::move(fault));
    }
  }
  for (const auto& [name, array] : content.arrays)
    if (!expected.contains(name)) wrong.push_back(fmt::format("{}: {} is no parameter of this network", name, text(array.shape)));
  if (!wrong.empty())
    throw Error("{}: {} of {} parameters do not fit the network:\n  {}", source, wrong.size(), expected.size(), fmt::join(wrong, "\n  "));
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
