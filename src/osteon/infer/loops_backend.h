// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <span>
#include <utility>
#include <vector>

#include "osteon/infer/parameters.h"
#include "osteon/tensor/tensor.h"

namespace osteon::infer {

// Runs a network operation by operation in plain loops, nothing merged or folded: what the product backend is tested against.
class Loops {
 public:
  using Tensor = tensor::Tensor;
  using Index = std::vector<std::int32_t>;

  explicit Loops(Parameters parameters) : parameters_(std::move(parameters)) {}

  Tensor tensor(std::span<const float> values, int rows, int columns);
  Index index(std::span<const std::int32_t> numbers) { return {numbers.begin(), numbers.end()}; }
  Tensor linear(const nets::Path& path, const Tensor& x, int width);
  Tensor batch_norm(const nets::Path& path, const Tensor& x);
  Tensor relu(const Tensor& x);
  Tensor subtract(const Tensor& x, const Tensor& y);
  Tensor concat(std::initializer_list<Tensor> parts);
  Tensor rows(const Tensor& x, const Index& picked);
  Tensor max_by(const Tensor& x, const Index& offsets);
  Tensor mean_of(const Tensor& x, const Index& offsets, const Index& sources);
  Tensor attend(const Tensor& x, const Index& offsets, const Index& sources, int heads);

  Matrix matrix(const Tensor& x) const { return x.matrix(); }

 private:
  Parameters parameters_;
};

}  // namespace osteon::infer
