// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cassert>
#include <cstddef>
#include <memory>
#include <span>

#include "osteon/base/types.h"

namespace osteon::tensor {

// A row-major (rows, columns) array of float32, 64-byte aligned: rows are vertices, messages, joints, pairs.
// Copies share the numbers. Whoever makes a tensor fills it before handing it on; from then on nobody writes to it.
// (Freed storage is kept and handed out again by the C library, whose threshold for returning memory grows with what was freed.)
class Tensor {
 public:
  Tensor() = default;
  Tensor(std::size_t rows, std::size_t columns);  // numbers unset
  explicit Tensor(const Matrix& numbers);

  std::size_t rows() const { return rows_; }
  std::size_t columns() const { return columns_; }
  float* data() { return data_.get(); }
  const float* data() const { return data_.get(); }
  std::span<float> row(std::size_t r) {
    assert(r < rows_);
    return {data_.get() + r * columns_, columns_};
  }
  std::span<const float> row(std::size_t r) const {
    assert(r < rows_);
    return {data_.get() + r * columns_, columns_};
  }
  Matrix matrix() const;  // a copy

 private:
  std::size_t rows_ = 0, columns_ = 0;
  std::shared_ptr<float[]> data_;
};

// Storage for `count` floats, 64-byte aligned, unset.
std::shared_ptr<float[]> aligned_floats(std::size_t count);

}  // namespace osteon::tensor
