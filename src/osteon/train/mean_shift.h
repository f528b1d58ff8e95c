// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ATen/ATen.h>

#include <vector>

namespace osteon::train {

// One step of the attention-weighted mean shift that RigNet trains through (section 3.3, equation 6; facts 5.3), differentiable in all
// three arguments. points (N,3), attention (N,1) >= 0, bandwidth (1):
//   k_ij = max(0, bandwidth^2 - |x_i - x_j|^2) a_i;   x_j <- x_j + step (sum_i k_ij x_i / (sum_i k_ij + 1e-10) - x_j)
// On the CPU by a hand-written pass that keeps no N x N matrix.
at::Tensor mean_shift_step(const at::Tensor& points, const at::Tensor& attention, const at::Tensor& bandwidth, double step = 0.3);

// The same by LibTorch operations, on any device.
at::Tensor plain_mean_shift_step(const at::Tensor& points, const at::Tensor& attention, const at::Tensor& bandwidth, double step = 0.3);

// The points after each of `steps` steps.
std::vector<at::Tensor> mean_shift(const at::Tensor& points, const at::Tensor& attention, const at::Tensor& bandwidth, int steps = 15);

}  // namespace osteon::train
