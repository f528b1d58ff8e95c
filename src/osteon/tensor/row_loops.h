// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

// The loops of the fast path that are not matrix products, compiled for several instruction sets and chosen at start-up.
namespace osteon::tensor {

// out[m] = max(0, at_receiver[receivers[m]] + at_source[sources[m]]), rows of `width` floats that lie `stride` floats apart.
void gather_add_relu(const float* at_receiver, const float* at_source, std::size_t stride, std::span<const std::int32_t> receivers,
                     std::span<const std::int32_t> sources, std::size_t width, float* out);

// best[receivers[m] - first] = max(itself, messages[m]), for dense rows of `width` floats. Pre: every receiver >= first.
void max_into(const float* messages, std::span<const std::int32_t> receivers, std::int32_t first, std::size_t width, float* best);

// best = the largest of each column of scale * x + shift, for dense rows. Pre: rows > 0.
void max_of_rows(const float* x, std::size_t rows, std::size_t width, const float* scale, const float* shift, float* best);

// out = max(0, x)
void relu_of_row(const float* x, std::size_t width, float* out);

// x = max(0, sign * x + shift), column by column, for dense rows.
void sign_shift_relu(float* x, std::size_t rows, std::size_t width, const float* sign, const float* shift);

// to = from rounded to bf16, the upper halves of floats (to nearest, ties to even). Pre: finite.
void to_bf16(const float* from, std::size_t count, std::uint16_t* to);

enum class Activation { none, relu };
// x[r] += addend[which[r]], then the activation; dense rows.
void add_gathered(float* x, std::size_t width, const float* addend, std::span<const std::int32_t> which, Activation activation);

// out = mean of the rows of x that `picked` names. Pre: at least one.
void mean_of_rows(const float* x, std::size_t width, std::span<const std::int32_t> picked, float* out);

// scores[i * heads + h] = query . x[picked[i]] in block h of `heads` equal blocks of the columns. Pre: blocks of a multiple of 16.
void head_products(const float* query, const float* x, std::size_t width, std::span<const std::int32_t> picked, std::size_t heads,
                   float* scores);

// out = sum over i of x[picked[i]], block h of the columns times weights[i * heads + h].
void sum_of_heads(const float* x, std::size_t width, std::span<const std::int32_t> picked, std::size_t heads, const float* weights,
                  float* out);

}  // namespace osteon::tensor
