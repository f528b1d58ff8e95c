// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace osteon::tensor {

// In what numbers products are computed; sums always in f32. bf16: 8 bits of mantissa, on processors that multiply it (AVX512-BF16, AMX;
// see has_bf16()), in layers that are wide enough to gain from it.
enum class Precision { f32, bf16 };
bool has_bf16();

}  // namespace osteon::tensor
