// SPDX-License-Identifier: Apache-2.0
#include "osteon/train/gemm.h"

#ifdef OSTEON_HAVE_ONEDNN
#include <dnnl.h>
#else
#include <ATen/ATen.h>
#endif

#include "osteon/base/error.h"

namespace osteon::train {

#ifdef OSTEON_HAVE_ONEDNN

void gemm(std::int64_t m, std::int64_t n, std::int64_t k, const MatrixView& a, const MatrixView& b, float beta, float* c,
          std::int64_t c_stride) {
  const auto letter = [](const MatrixView& x) { return x.transposed == Transposed::yes ? 'T' : 'N'; };
  const dnnl_status_t status =
      dnnl_sgemm(letter(a), letter(b), m, n, k, 1.0f, a.data, a.row_stride, b.data, b.row_stride, beta, c, c_stride);
  if (status != dnnl_success) throw Error("oneDNN: sgemm {} x {} x {} failed with status {}", m, n, k, static_cast<int>(status));
}

#else

void gemm(std::int64_t m, std::int64_t n, std::int64_t k, const MatrixView& a, const MatrixView& b, float beta, float* c,
          std::int64_t c_stride) {
  const at::NoGradGuard no_grad;
  const auto view = [](const MatrixView& x, std::int64_t rows, std::int64_t columns) {
    const bool turned = x.transposed == Transposed::yes;
    return at::from_blob(const_cast<float*>(x.data), {rows, columns}, {turned ? 1 : x.row_stride, turned ? x.row_stride : 1}, at::kFloat);
  };
  at::Tensor out = at::from_blob(c, {m, n}, {c_stride, 1}, at::kFloat);
  const at::Tensor product = at::mm(view(a, m, k), view(b, k, n));
  if (beta == 0.0f)
    out.copy_(product);
  else
    out.mul_(beta).add_(product);
}

#endif

}  // namespace osteon::train
