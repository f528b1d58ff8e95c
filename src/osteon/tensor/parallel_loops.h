// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "osteon/tensor/tensor.h"

// What the loops of the same names compute (loops.h), on all cores. The same bits for any number of threads.
namespace osteon::tensor {

Tensor relu(const Tensor& x);
Tensor scale_shift(const Tensor& x, std::span<const float> scale, std::span<const float> shift);
Tensor rows(const Tensor& x, std::span<const std::int32_t> picked);
Tensor mean_of(const Tensor& x, std::span<const std::int32_t> offsets, std::span<const std::int32_t> sources);

// The maximum of scale * x + shift, column by column. Pre: every segment has a row.
Tensor max_by(const Tensor& x, std::span<const std::int32_t> offsets, std::span<const float> scale, std::span<const float> shift);

// A vertex's rows are read twice, from the cache the second time; no edge stores anything but its score. Pre: the width of a head is a
// multiple of 16.
Tensor attend(const Tensor& x, std::span<const std::int32_t> offsets, std::span<const std::int32_t> sources, std::size_t heads);

}  // namespace osteon::tensor
