// SPDX-License-Identifier: Apache-2.0
#include "osteon/tensor/tensor.h"

#include <algorithm>
#include <new>

namespace osteon::tensor {

std::shared_ptr<float[]> aligned_floats(std::size_t count) {
  constexpr std::align_val_t alignment{64};
  void* storage = ::operator new(std::max<std::size_t>(count, 1) * sizeof(float), alignment);
  return {static_cast<float*>(storage), [](float* p) { ::operator delete (p, std::align_val_t{64}); }};
}

Tensor::Tensor(std::size_t rows, std::size_t columns) : rows_(rows), columns_(columns), data_(aligned_floats(rows * columns)) {}

Tensor::Tensor(const Matrix& numbers) : Tensor(static_cast<std::size_t>(numbers.rows()), static_cast<std::size_t>(numbers.cols())) {
  std::copy_n(numbers.data(), numbers.size(), data_.get());
}

Matrix Tensor::matrix() const {
  Matrix out(static_cast<Eigen::Index>(rows_), static_cast<Eigen::Index>(columns_));
  std::copy_n(data_.get(), out.size(), out.data());
  return out;
}

}  // namespace osteon::tensor
