// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "osteon/tensor/tensor.h"

// Every operation as the plainest loop that computes it: what the fast kernels are tested against.
namespace osteon::tensor::loops {

Tensor linear(const Tensor& x, const Matrix& weights, std::span<const float> bias);               // x Wᵀ + b; weights (outputs, inputs)
Tensor scale_shift(const Tensor& x, std::span<const float> scale, std::span<const float> shift);  // column by column
Tensor relu(const Tensor& x);
Tensor subtract(const Tensor& x, const Tensor& y);
Tensor concat(std::span<const Tensor> parts);                           // columns side by side
Tensor rows(const Tensor& x, std::span<const std::int32_t> picked);     // out[k] = x[picked[k]]
Tensor max_by(const Tensor& x, std::span<const std::int32_t> offsets);  // out[s] = max of rows offsets[s] .. offsets[s+1]-1, at least one

// out[v] = mean of the rows sources[offsets[v]] .. sources[offsets[v+1]-1] of x, at least one.
Tensor mean_of(const Tensor& x, std::span<const std::int32_t> offsets, std::span<const std::int32_t> sources);

// In each of `heads` equal blocks of the columns: out[v] = sum over the same rows u of a_u x[u], a = softmax of x[v] . x[u] over them.
Tensor attend(const Tensor& x, std::span<const std::int32_t> offsets, std::span<const std::int32_t> sources, std::size_t heads);

}  // namespace osteon::tensor::loops
