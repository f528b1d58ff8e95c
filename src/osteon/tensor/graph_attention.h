// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>

#include "osteon/tensor/tensor.h"

// What loops::mean_of and loops::attend compute, on all cores. The same bits for any number of threads.
namespace osteon::tensor {

Tensor mean_of(const Tensor& x, std::span<const std::int32_t> offsets, std::span<const std::int32_t> sources);

// A vertex's rows are read twice, from the cache the second time; no edge stores anything but its score. Pre: the width of a head is a
// multiple of 16.
Tensor attend(const Tensor& x, std::span<const std::int32_t> offsets, std::span<const std::int32_t> sources, std::size_t heads);

}  // namespace osteon::tensor
