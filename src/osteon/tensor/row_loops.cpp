// SPDX-License-Identifier: Apache-2.0
#include "osteon/tensor/row_loops.h"

#include <bit>

#include "osteon/base/every_cpu.h"

namespace osteon::tensor {

OSTEON_EVERY_CPU void gather_add_relu(const float* at_receiver, const float* at_source, std::size_t stride,
                                      std::span<const std::int32_t> receivers, std::span<const std::int32_t> sources, std::size_t width,
                                      float* out) {
  for (std::size_t m = 0; m < receivers.size(); ++m) {
    const float* __restrict p = at_receiver + static_cast<std::size_t>(receivers[m]) * stride;
    const float* __restrict q = at_source + static_cast<std::size_t>(sources[m]) * stride;
    float* __restrict o = out + m * width;
    for (std::size_t c = 0; c < width; ++c) {
      const float sum = p[c] + q[c];
      o[c] = sum > 0 ? sum : 0;
    }
  }
}

OSTEON_EVERY_CPU void max_into(const float* messages, std::span<const std::int32_t> receivers, std::int32_t first, std::size_t width,
                               float* best) {
  for (std::size_t m = 0; m < receivers.size(); ++m) {
    const float* __restrict z = messages + m * width;
    float* __restrict b = best + static_cast<std::size_t>(receivers[m] - first) * width;
    for (std::size_t c = 0; c < width; ++c) b[c] = z[c] > b[c] ? z[c] : b[c];
  }
}

OSTEON_EVERY_CPU void max_of_rows(const float* x, std::size_t rows, std::size_t width, const float* __restrict scale,
                                  const float* __restrict shift, float* __restrict best) {
  for (std::size_t c = 0; c < width; ++c) best[c] = scale[c] * x[c] + shift[c];
  for (std::size_t r = 1; r < rows; ++r) {
    const float* __restrict row = x + r * width;
    for (std::size_t c = 0; c < width; ++c) {
      const float value = scale[c] * row[c] + shift[c];
      best[c] = value > best[c] ? value : best[c];
    }
  }
}

OSTEON_EVERY_CPU void relu_of_row(const float* __restrict x, std::size_t width, float* __restrict out) {
  for (std::size_t c = 0; c < width; ++c) out[c] = x[c] > 0 ? x[c] : 0;
}

OSTEON_EVERY_CPU void sign_shift_relu(float* x, std::size_t rows, std::size_t width, const float* __restrict sign,
                                      const float* __restrict shift) {
  for (std::size_t r = 0; r < rows; ++r) {
    float* __restrict row = x + r * width;
    for (std::size_t c = 0; c < width; ++c) {
      const float value = sign[c] * row[c] + shift[c];
      row[c] = value > 0 ? value : 0;
    }
  }
}

OSTEON_EVERY_CPU void to_bf16(const float* __restrict from, std::size_t count, std::uint16_t* __restrict to) {
  for (std::size_t i = 0; i < count; ++i) {
    const auto bits = std::bit_cast<std::uint32_t>(from[i]);
    to[i] = static_cast<std::uint16_t>((bits + 0x7fff + ((bits >> 16) & 1)) >> 16);
  }
}

OSTEON_EVERY_CPU void add_gathered(float* x, std::size_t width, const float* addend, std::span<const std::int32_t> which,
                                   Activation activation) {
  const float least = activation == Activation::relu ? 0.0f : -__builtin_inff();
  for (std::size_t r = 0; r < which.size(); ++r) {
    float* __restrict row = x + r * width;
    const float* __restrict more = addend + static_cast<std::size_t>(which[r]) * width;
    for (std::size_t c = 0; c < width; ++c) {
      const float value = row[c] + more[c];
      row[c] = value > least ? value : least;
    }
  }
}

OSTEON_EVERY_CPU void mean_of_rows(const float* x, std::size_t width, std::span<const std::int32_t> picked, float* __restrict out) {
  constexpr std::size_t lanes = 64;  // sums that stay in registers
  const float share = 1.0f / static_cast<float>(picked.size());
  std::size_t first = 0;
  for (; first + lanes <= width; first += lanes) {
    float sums[lanes] = {};
    for (const std::int32_t row : picked) {
      const float* __restrict from = x + static_cast<std::size_t>(row) * width + first;
      for (std::size_t i = 0; i < lanes; ++i) sums[i] += from[i];
    }
    for (std::size_t i = 0; i < lanes; ++i) out[first + i] = share * sums[i];
  }
  for (std::size_t c = first; c < width; ++c) {
    float sum = 0.0f;
    for (const std::int32_t row : picked) sum += x[static_cast<std::size_t>(row) * width + c];
    out[c] = share * sum;
  }
}

OSTEON_EVERY_CPU void head_products(const float* __restrict query, const float* x, std::size_t width, std::span<const std::int32_t> picked,
                                    std::size_t heads, float* __restrict scores) {
  constexpr std::size_t lanes = 16;  // fixed, so that every instruction set adds up in one order
  const std::size_t block = width / heads;
  for (const std::int32_t row : picked) {
    for (std::size_t h = 0; h < heads; ++h) {
      const float* __restrict p = query + h * block;
      const float* __restrict q = x + static_cast<std::size_t>(row) * width + h * block;
      float sums[lanes] = {};
      for (std::size_t c = 0; c < block; c += lanes)
        for (std::size_t i = 0; i < lanes; ++i) sums[i] += p[c + i] * q[c + i];
      for (std::size_t half = lanes / 2; half > 0; half /= 2)
        for (std::size_t i = 0; i < half; ++i) sums[i] += sums[i + half];
      *scores++ = sums[0];
    }
  }
}

OSTEON_EVERY_CPU void sum_of_heads(const float* x, std::size_t width, std::span<const std::int32_t> picked, std::size_t heads,
                                   const float* __restrict weights, float* __restrict out) {
  const std::size_t block = width / heads;
  for (std::size_t c = 0; c < width; ++c) out[c] = 0.0f;
  for (const std::int32_t row : picked)
    for (std::size_t h = 0; h < heads; ++h) {
      const float weight = *weights++;
      const float* __restrict from = x + static_cast<std::size_t>(row) * width + h * block;
      float* __restrict to = out + h * block;
      for (std::size_t c = 0; c < block; ++c) to[c] += weight * from[c];
    }
}

}  // namespace osteon::tensor
