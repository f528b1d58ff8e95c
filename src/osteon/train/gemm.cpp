// SPDX-License-Identifier: Apache-2.0
#include "osteon/train/gemm.h"

#ifdef OSTEON_HAVE_ONEDNN
#include <dnnl.h>
#else
#include <ATen/ATen.h>
#include <ATen/core/grad_mode.h>
#endif

#include <atomic>

#include "osteon/base/error.h"
#include "osteon/train/step_profile.h"

namespace osteon::train {
namespace {

// Adds up what gemm() does; two readings of the clock, 0.05 microseconds, beside 20 and more of a product.
class Tally {
 public:
  explicit Tally(std::int64_t multiplications) : multiplications_(multiplications) {}
  ~Tally() {
    all_nanoseconds += static_cast<std::int64_t>(1e9 * watch_.seconds());
    all_multiplications += multiplications_;
  }
  Tally(const Tally&) = delete;
  Tally& operator=(const Tally&) = delete;

  static inline std::atomic<std::int64_t> all_nanoseconds = 0, all_multiplications = 0;

 private:
  Stopwatch watch_;
  std::int64_t multiplications_;
};

}  // namespace

GemmTotals gemm_totals() { return {1e-9 * static_cast<double>(Tally::all_nanoseconds), static_cast<double>(Tally::all_multiplications)}; }

#ifdef OSTEON_HAVE_ONEDNN

void gemm(std::int64_t m, std::int64_t n, std::int64_t k, const MatrixView& a, const MatrixView& b, float beta, float* c,
          std::int64_t c_stride) {
  const Tally tally(m * n * k);
  const auto letter = [](const MatrixView& x) { return x.transposed == Transposed::yes ? 'T' : 'N'; };
  const dnnl_status_t status =
      dnnl_sgemm(letter(a), letter(b), m, n, k, 1.0f, a.data, a.row_stride, b.data, b.row_stride, beta, c, c_stride);
  if (status != dnnl_success) throw Error("oneDNN: sgemm {} x {} x {} failed with status {}", m, n, k, static_cast<int>(status));
}

#else

void gemm(std::int64_t m, std::int64_t n, std::int64_t k, const MatrixView& a, const MatrixView& b, float beta, float* c,
          std::int64_t c_stride) {
  const Tally tally(m * n * k);
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
