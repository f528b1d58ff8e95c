// SPDX-License-Identifier: Apache-2.0
#include "osteon/infer/loops_backend.h"

#include <algorithm>
#include <cassert>

#include "osteon/infer/folding.h"
#include "osteon/tensor/loops.h"

namespace osteon::infer {

namespace loops = tensor::loops;
using nets::Path;

Loops::Tensor Loops::tensor(std::span<const float> values, int rows, int columns) {
  Tensor out(static_cast<std::size_t>(rows), static_cast<std::size_t>(columns));
  assert(values.size() == out.rows() * out.columns());
  std::ranges::copy(values, out.data());
  return out;
}

Loops::Tensor Loops::linear(const Path& path, const Tensor& x, [[maybe_unused]] int width) {
  const Matrix& bias = parameters_.at(path / "bias");
  assert(bias.size() == width);
  return loops::linear(x, parameters_.at(path / "weight"), {bias.data(), static_cast<std::size_t>(bias.size())});
}

Loops::Tensor Loops::batch_norm(const Path& path, const Tensor& x) {
  const Affine affine = normalization(parameters_, path);
  return loops::scale_shift(x, affine.scale, affine.shift);
}

Loops::Tensor Loops::relu(const Tensor& x) { return loops::relu(x); }
Loops::Tensor Loops::subtract(const Tensor& x, const Tensor& y) { return loops::subtract(x, y); }
Loops::Tensor Loops::concat(std::initializer_list<Tensor> parts) { return loops::concat({parts.begin(), parts.size()}); }
Loops::Tensor Loops::rows(const Tensor& x, const Index& picked) { return loops::rows(x, picked); }
Loops::Tensor Loops::max_by(const Tensor& x, const Index& offsets) { return loops::max_by(x, offsets); }
Loops::Tensor Loops::mean_of(const Tensor& x, const Index& offsets, const Index& sources) { return loops::mean_of(x, offsets, sources); }
Loops::Tensor Loops::attend(const Tensor& x, const Index& offsets, const Index& sources, int heads) {
  return loops::attend(x, offsets, sources, static_cast<std::size_t>(heads));
}

}  // namespace osteon::infer
