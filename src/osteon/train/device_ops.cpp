// SPDX-License-Identifier: Apache-2.0
#include "osteon/train/device_ops.h"

namespace osteon::train {
namespace {

using torch::Tensor;
using torch::autograd::AutogradContext;
using torch::autograd::variable_list;

struct SharedSegmentMax : torch::autograd::Function<SharedSegmentMax> {
  static Tensor forward(AutogradContext* context, const Tensor& x, const Tensor& offsets) {
    Tensor best = at::segment_reduce(x, "max", {}, {}, offsets, 0, true);
    context->save_for_backward({x, offsets, best});
    return best;
  }

  static variable_list backward(AutogradContext* context, variable_list gradients) {
    const variable_list saved = context->get_saved_variables();
    const Tensor &x = saved[0], &offsets = saved[1], &best = saved[2];
    const std::int64_t segments = best.size(0);
    const Tensor row = at::arange(x.size(0), offsets.options());
    const Tensor segment = at::searchsorted(offsets.narrow(0, 1, segments), row, false, true);
    const Tensor is_best = (x == best.index_select(0, segment)).to(x.scalar_type());
    const Tensor count = at::zeros_like(best).index_add_(0, segment, is_best);
    return {(gradients[0] / count).index_select(0, segment).mul_(is_best), Tensor()};
  }
};

}  // namespace

Tensor shared_segment_max(const Tensor& x, const Tensor& offsets) { return SharedSegmentMax::apply(x, offsets); }

}  // namespace osteon::train
