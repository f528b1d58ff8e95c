// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "osteon/infer/networks.h"

namespace osteon::torch_infer {

// Networks on LibTorch, on any device that it has: "cpu", "cuda", "cuda:1". The same functions as oneDNN's, but for rounding: 1e-4 of the
// largest value. Throws Error where there is no such device.
infer::RunnerFactory torch_runners(const std::string& device);

}  // namespace osteon::torch_infer
