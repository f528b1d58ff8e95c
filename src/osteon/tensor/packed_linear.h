// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <span>

#include "osteon/base/types.h"
#include "osteon/tensor/precision.h"
#include "osteon/tensor/row_loops.h"

namespace osteon::tensor {

// y = x Wᵀ + b and optionally max(0, ·), its weights rearranged once for this processor.
//
// Rows are computed by single-threaded oneDNN products of fixed heights, the last one filled up with unused rows. So a row's result
// depends neither on the other rows nor on the thread count; callers cut the rows into ranges for parallel_for (oneDNN's own OpenMP threads
// would cut along whichever dimension suits the thread count).
class PackedLinear {
 public:
  // weights: (outputs, inputs) as PyTorch stores them; bias: (outputs), or empty for none.
  // Pre: precision is f32 or has_bf16().
  PackedLinear(const Matrix& weights, std::span<const float> bias, Activation activation, Precision precision = Precision::f32);
  ~PackedLinear();
  PackedLinear(PackedLinear&&) noexcept;
  PackedLinear& operator=(PackedLinear&&) noexcept;

  std::size_t inputs() const;
  std::size_t outputs() const;
  // in: (rows, inputs) dense, out: (rows, outputs) dense; must not overlap. May be called from several threads at once.
  void operator()(const float* in, std::size_t rows, float* out) const;
  // The height of a product; ranges and tiles of a multiple of it waste nothing.
  std::size_t tile_rows() const;

 private:
  struct Kernels;
  std::unique_ptr<Kernels> kernels_;
};

// Storage for one of a thread's intermediate results: stays valid until the same slot is asked for again in the same thread.
float* thread_scratch(int slot, std::size_t count);

}  // namespace osteon::tensor
