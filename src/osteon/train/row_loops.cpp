// SPDX-License-Identifier: Apache-2.0
#include "osteon/train/row_loops.h"

#include <limits>

#include "osteon/train/hot.h"

namespace osteon::train {
namespace {

inline float relu(float x) { return x > 0.0f ? x : 0.0f; }

}  // namespace

OSTEON_HOT void edge_hidden(const EdgeTerms& terms, const EdgeRange& range, float* h) {
  const std::int64_t width = terms.width;
  for (std::int64_t v = range.first; v < range.last; ++v) {
    const float* receiver = terms.values + v * 2 * width;
    for (std::int32_t e = range.offsets[v]; e < range.offsets[v + 1]; ++e, h += width) {
      const float* source = terms.values + range.sources[e] * 2 * width + width;
#pragma GCC ivdep
      for (std::int64_t c = 0; c < width; ++c) h[c] = relu(receiver[c] + source[c]);
    }
  }
}

OSTEON_HOT void edge_hidden_moments(const EdgeTerms& terms, const EdgeRange& range, float* sum, float* squares) {
  const std::int64_t width = terms.width;
  for (std::int64_t v = range.first; v < range.last; ++v) {
    const float* receiver = terms.values + v * 2 * width;
    for (std::int32_t e = range.offsets[v]; e < range.offsets[v + 1]; ++e) {
      const float* source = terms.values + range.sources[e] * 2 * width + width;
#pragma GCC ivdep
      for (std::int64_t c = 0; c < width; ++c) {
        const float h = relu(receiver[c] + source[c]);
        sum[c] += h;
        squares[c] += h * h;
      }
    }
  }
}

OSTEON_HOT void edge_maximum(const EdgeRange& range, std::int64_t width, float* r, const EdgeMaximum& out) {
  for (std::int64_t v = range.first; v < range.last; ++v) {
    float* best = out.best + v * width;
    std::int32_t* arg = out.arg + v * width;
    for (std::int64_t c = 0; c < width; ++c) best[c] = -std::numeric_limits<float>::infinity();
    for (std::int32_t e = range.offsets[v]; e < range.offsets[v + 1]; ++e, r += width) {
#pragma GCC ivdep
      for (std::int64_t c = 0; c < width; ++c) {
        const float value = relu(r[c] + out.bias[c]);
        const float signed_value = out.sign[c] * value;
        const bool better = signed_value > best[c];
        r[c] = value;
        out.sum[c] += value;
        out.squares[c] += value * value;
        best[c] = better ? signed_value : best[c];
        arg[c] = better ? e : arg[c];
      }
    }
  }
}

OSTEON_HOT void edge_maximum_backward(const EdgeRange& range, std::int64_t width, float* r, const EdgeMaximumGradient& in) {
  for (std::int64_t v = range.first; v < range.last; ++v) {
    const float* gradient = in.gradient + v * width;
    const std::int32_t* arg = in.arg + v * width;
    for (std::int32_t e = range.offsets[v]; e < range.offsets[v + 1]; ++e, r += width) {
#pragma GCC ivdep
      for (std::int64_t c = 0; c < width; ++c) {
        const float chosen = arg[c] == e ? gradient[c] : 0.0f;
        const float d = in.scale[c] * chosen - in.constant[c] - in.slope[c] * r[c];
        const float passed = r[c] > 0.0f ? d : 0.0f;
        r[c] = passed;
        in.sum[c] += passed;
      }
    }
  }
}

OSTEON_HOT void edge_hidden_backward(const EdgeRange& range, std::int64_t width, const float* h, const float* d,
                                     const EdgeHiddenGradient& out) {
  const float *constant = out.constant, *slope = out.slope;
  float* dh = out.dh;
  for (std::int64_t v = range.first; v < range.last; ++v) {
    float* receiver = out.receivers + v * 2 * width;
    for (std::int64_t c = 0; c < width; ++c) receiver[c] = 0.0f;
    for (std::int32_t e = range.offsets[v]; e < range.offsets[v + 1]; ++e, h += width, d += width, dh += width) {
#pragma GCC ivdep
      for (std::int64_t c = 0; c < width; ++c) {
        const float through_norm = d[c] - constant[c] - slope[c] * h[c];
        const float passed = h[c] > 0.0f ? through_norm : 0.0f;
        dh[c] = passed;
        receiver[c] += passed;
      }
    }
  }
}

OSTEON_HOT void sum_rows(const RowGroups& groups, const float* x, std::int64_t width, float* out, std::int64_t stride) {
  for (std::int64_t v = groups.first; v < groups.last; ++v) {
    float* target = out + v * stride;
    for (std::int64_t c = 0; c < width; ++c) target[c] = 0.0f;
    for (std::int32_t k = groups.offsets[v]; k < groups.offsets[v + 1]; ++k) {
      const float* row = x + groups.items[k] * width;
#pragma GCC ivdep
      for (std::int64_t c = 0; c < width; ++c) target[c] += row[c];
    }
  }
}

OSTEON_HOT void row_maximum(const Rows& x, std::int64_t first, std::int64_t last, float* best, std::int32_t* arg) {
  const std::int64_t width = x.width;
  for (std::int64_t c = 0; c < width; ++c) {
    best[c] = -std::numeric_limits<float>::infinity();
    arg[c] = static_cast<std::int32_t>(first);  // columns that are no numbers have a place too: the gradient is written there
  }
  for (std::int64_t i = first; i < last; ++i) {
    const float* row = x.values + i * width;
#pragma GCC ivdep
    for (std::int64_t c = 0; c < width; ++c) {
      const bool better = row[c] > best[c];
      best[c] = better ? row[c] : best[c];
      arg[c] = better ? static_cast<std::int32_t>(i) : arg[c];
    }
  }
}

OSTEON_HOT void relu_moments(const float* x, std::int64_t rows, std::int64_t width, float* sum, float* squares) {
  for (std::int64_t i = 0; i < rows; ++i, x += width) {
#pragma GCC ivdep
    for (std::int64_t c = 0; c < width; ++c) {
      const float r = relu(x[c]);
      sum[c] += r;
      squares[c] += r * r;
    }
  }
}

OSTEON_HOT void relu_affine(const float* x, std::int64_t rows, std::int64_t width, const float* scale, const float* shift, float* y) {
  for (std::int64_t i = 0; i < rows; ++i, x += width, y += width) {
#pragma GCC ivdep
    for (std::int64_t c = 0; c < width; ++c) y[c] = scale[c] * relu(x[c]) + shift[c];
  }
}

OSTEON_HOT void relu_affine_sums(const float* x, const float* gradient, std::int64_t rows, std::int64_t width, float* sum, float* product) {
  for (std::int64_t i = 0; i < rows; ++i, x += width, gradient += width) {
#pragma GCC ivdep
    for (std::int64_t c = 0; c < width; ++c) {
      sum[c] += gradient[c];
      product[c] += gradient[c] * relu(x[c]);
    }
  }
}

OSTEON_HOT void relu_affine_backward(const float* x, const float* gradient, std::int64_t rows, std::int64_t width,
                                     const ReluAffineGradient& by, float* dx) {
  for (std::int64_t i = 0; i < rows; ++i, x += width, gradient += width, dx += width) {
#pragma GCC ivdep
    for (std::int64_t c = 0; c < width; ++c) {
      const float d = by.scale[c] * gradient[c] - by.constant[c] - by.slope[c] * x[c];
      dx[c] = x[c] > 0.0f ? d : 0.0f;
    }
  }
}

OSTEON_HOT float dot(const float* __restrict a, const float* __restrict b, std::int64_t width) {
  constexpr std::int64_t lanes = 16;
  float sums[lanes] = {}, rest = 0.0f;
  std::int64_t c = 0;
  for (; c + lanes <= width; c += lanes)
    for (std::int64_t i = 0; i < lanes; ++i) sums[i] += a[c + i] * b[c + i];
  for (; c < width; ++c) rest += a[c] * b[c];
  for (std::int64_t half = lanes / 2; half > 0; half /= 2)
    for (std::int64_t i = 0; i < half; ++i) sums[i] += sums[i + half];
  return sums[0] + rest;
}

OSTEON_HOT void add_scaled(const float* __restrict x, std::int64_t width, float scale, float* __restrict y) {
  for (std::int64_t c = 0; c < width; ++c) y[c] += scale * x[c];
}

OSTEON_HOT void column_sums(const float* x, std::int64_t rows, std::int64_t width, float* sum) {
  for (std::int64_t i = 0; i < rows; ++i, x += width) {
#pragma GCC ivdep
    for (std::int64_t c = 0; c < width; ++c) sum[c] += x[c];
  }
}

}  // namespace osteon::train
