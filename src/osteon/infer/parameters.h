// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "osteon/base/safetensors.h"
#include "osteon/base/types.h"
#include "osteon/nets/ops.h"

namespace osteon::infer {

using Shapes = std::map<std::string, std::vector<std::int64_t>>;  // parameter -> shape, as a dry run lists them

// The parameters of one network as float32: exactly those of `expected`, all finite, variances not negative.
class Parameters {
 public:
  // f32 or f16. Throws one Error that names `source` and every difference: missing, unknown, other shape or type, not finite.
  Parameters(const Safetensors& content, const Shapes& expected, std::string_view source);

  // Pre: the name is one of `expected` and has one or two dimensions. A vector is a single row.
  const Matrix& at(const nets::Path& name) const;
  void forget(const nets::Path& layer);  // frees what the name is a prefix of; nothing may ask for it afterwards

 private:
  std::map<std::string, Matrix> matrices_;
};

Parameters load_parameters(const std::filesystem::path& file, const Shapes& expected);

}  // namespace osteon::infer
