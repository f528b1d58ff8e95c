// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

namespace osteon::train {

enum class Transposed { no, yes };

struct MatrixView {
  const float* data;
  std::int64_t row_stride;  // floats from one stored row to the next
  Transposed transposed = Transposed::no;
};

// c (m,n; rows `c_stride` apart) = a (m,k) b (k,n) + beta c. Runs in the calling thread when called from at::parallel_for.
// By oneDNN where it was found at build time, otherwise by ATen: Debian's OpenBLAS reaches 17 GFLOP/s on a core where oneDNN reaches 110.
void gemm(std::int64_t m, std::int64_t n, std::int64_t k, const MatrixView& a, const MatrixView& b, float beta, float* c,
          std::int64_t c_stride);

// All products so far in this process: their time, summed over threads, and how many pairs of numbers they multiplied.
struct GemmTotals {
  double seconds, multiplications;
};
GemmTotals gemm_totals();

}  // namespace osteon::train
