// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/nets/layers.h"
#include "osteon/train/torch_ops.h"

namespace osteon::train {

// The largest of each segment, (S,C); rows that share it share its gradient. LibTorch's segment_reduce gives each of them the whole of a
// gradient that is negative (seen in 1.13 and 2.11), and after a ReLU many are equal.
torch::Tensor shared_segment_max(const torch::Tensor& x, const torch::Tensor& offsets);

// nets::Ops for training on a GPU: the same functions as TorchOps (see fused_ops_test) by few passes over memory, which is what bounds them
// there. Nothing is put side by side only to be multiplied; the first layer of an edge convolution acts once per vertex, as in FusedOps;
// one of LibTorch's kernels normalises.
class DeviceOps : public TorchOps {
 public:
  using TorchOps::TorchOps;

  Tensor batch_norm(const nets::Path& path, const Tensor& x) {
    if (mode_ != Mode::training || !rule_.renormalises()) return TorchOps::batch_norm(path, x);
    const Tensor &weight = at(path / "weight"), &bias = at(path / "bias");
    const Correction r = corrected(path, x);
    return torch::batch_norm(x, weight * r.stretch, bias + weight * r.offset, {}, {}, true, 0.0, nets::norm_epsilon, true);
  }
  Tensor max_by(const Tensor& x, const Index& offsets) { return shared_segment_max(x, offsets); }

  Tensor linear_of(const nets::Path& path, const nets::Input<DeviceOps>& input, int) {
    const Tensor& weight = at(path / "weight");
    Tensor y = at(path / "bias");
    std::int64_t column = 0;
    for (const auto& part : input) {
      const std::int64_t columns = part.values.size(1);
      const Tensor block = weight.narrow(1, column, columns).t();
      column += columns;
      if (part.rows)
        y = y + rows(part.values.mm(block), *part.rows);
      else
        y = torch::addmm(y, part.values, block);
    }
    return y;
  }

  // W1 [x_v, x_u - x_v] = (A - B) x_v + B x_u with W1 = [A | B].
  Tensor edge_conv(const nets::Path& path, const Tensor& x, const nets::Edges<DeviceOps>& edges, int) {
    const nets::Path first = path / 0, second = path / 1;
    const Tensor& weight = at(first / "linear" / "weight");
    const std::int64_t columns = x.size(1);
    const Tensor of_difference = weight.narrow(1, columns, columns), of_receiver = weight.narrow(1, 0, columns) - of_difference;
    Tensor hidden = rows(torch::addmm(at(first / "linear" / "bias"), x, of_receiver.t()), edges.receivers);
    hidden.add_(rows(x.mm(of_difference.t()), edges.sources)).relu_();
    const Tensor normal = batch_norm(first / "norm", hidden);
    const Tensor message = linear(second / "linear", normal, 0).relu_();
    return max_by(batch_norm(second / "norm", message), edges.offsets);
  }
};

}  // namespace osteon::train
