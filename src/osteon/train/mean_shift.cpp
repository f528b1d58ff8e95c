// SPDX-License-Identifier: Apache-2.0
#include "osteon/train/mean_shift.h"

#include <torch/autograd.h>
#include <torch/types.h>

#include "osteon/train/mean_shift_loops.h"
#include "osteon/train/norm.h"

namespace osteon::train {
namespace {

using torch::Tensor;
using torch::autograd::AutogradContext;
using torch::autograd::variable_list;

constexpr double tiny = 1e-10;  // keeps a point without sources in place

const float* column(const Tensor& columns, int i) { return columns.data_ptr<float>() + i * columns.size(1); }
float* column(Tensor& columns, int i) { return columns.data_ptr<float>() + i * columns.size(1); }

PointColumns points_of(const Tensor& columns) { return {column(columns, 0), column(columns, 1), column(columns, 2), columns.size(1)}; }

// Columns (3,N) and weights are saved, N x N kernels are computed again.
struct MeanShiftStep : torch::autograd::Function<MeanShiftStep> {
  static Tensor forward(AutogradContext* context, const Tensor& points, const Tensor& attention, const Tensor& bandwidth, double step) {
    const Tensor columns = points.t().contiguous(), weights = attention.contiguous();
    const float h = bandwidth.item<float>();
    Tensor sums = torch::empty({4, points.size(0)});
    for_row_groups(points.size(0), [&](int, std::int64_t first, std::int64_t last) {
      kernel_sums(points_of(columns), weights.data_ptr<float>(), h * h, first, last,
                  {column(sums, 0), column(sums, 1), column(sums, 2), column(sums, 3)});
    });
    const Tensor total = sums.narrow(0, 0, 1) + tiny, mean = sums.narrow(0, 1, 3) / total;
    context->save_for_backward({columns, weights, total, mean});
    context->saved_data["h"] = static_cast<double>(h);
    context->saved_data["step"] = step;
    return (columns + step * (mean - columns)).t();
  }

  static variable_list backward(AutogradContext* context, variable_list gradients) {
    const variable_list saved = context->get_saved_variables();
    const Tensor &columns = saved[0], &weights = saved[1], &total = saved[2], &mean = saved[3];
    const double step = context->saved_data["step"].toDouble();
    const auto h = static_cast<float>(context->saved_data["h"].toDouble());
    const Tensor g = gradients[0].t().contiguous();
    const Tensor w = (step * g / total).contiguous(), offset = (w * mean).sum(0);
    Tensor out = torch::empty({5, columns.size(1)});
    for_row_groups(columns.size(1), [&](int, std::int64_t first, std::int64_t last) {
      kernel_gradients(points_of(columns), weights.data_ptr<float>(), h * h,
                       {column(w, 0), column(w, 1), column(w, 2), offset.data_ptr<float>()}, first, last,
                       {column(out, 0), column(out, 1), column(out, 2), column(out, 3), column(out, 4)});
    });
    const Tensor d_points = (out.narrow(0, 0, 3) + (1.0 - step) * g).t();
    return {d_points, out.narrow(0, 3, 1).t(), (2.0f * h * out[4].sum()).view({1}), Tensor()};
  }
};

}  // namespace

at::Tensor plain_mean_shift_step(const at::Tensor& points, const at::Tensor& attention, const at::Tensor& bandwidth, double step) {
  const Tensor squared = (points.unsqueeze(1) - points.unsqueeze(0)).square().sum(2);  // [source, target]
  const Tensor kernel = torch::relu(bandwidth.square() - squared) * attention;
  const Tensor mean = kernel.t().mm(points) / (kernel.sum(0).unsqueeze(1) + tiny);
  return points + step * (mean - points);
}

at::Tensor mean_shift_step(const at::Tensor& points, const at::Tensor& attention, const at::Tensor& bandwidth, double step) {
  if (!points.device().is_cpu()) return plain_mean_shift_step(points, attention, bandwidth, step);
  return MeanShiftStep::apply(points, attention, bandwidth, step);
}

std::vector<at::Tensor> mean_shift(const at::Tensor& points, const at::Tensor& attention, const at::Tensor& bandwidth, int steps) {
  std::vector<at::Tensor> trail;
  at::Tensor now = points;
  for (int i = 0; i < steps; ++i) trail.push_back(now = mean_shift_step(now, attention, bandwidth));
  return trail;
}

}  // namespace osteon::train
