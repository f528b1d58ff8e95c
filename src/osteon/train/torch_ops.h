// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <torch/autograd.h>
#include <torch/types.h>

#include <algorithm>
#include <initializer_list>
#include <span>

#include "osteon/base/error.h"
#include "osteon/nets/ops.h"
#include "osteon/train/networks.h"
#include "osteon/train/norm.h"

namespace osteon::train {

// nets::Ops by plain LibTorch operations, on any device: the reference for FusedOps and DeviceOps.
class TorchOps {
 public:
  using Tensor = torch::Tensor;
  using Index = torch::Tensor;  // 32-bit

  TorchOps(Parameters& parameters, Mode mode, torch::Device device, const NormRule& rule = {})
      : parameters_(parameters), mode_(mode), device_(device), rule_(rule) {}

  Tensor tensor(std::span<const float> values, int rows, int columns) const {
    return torch::from_blob(const_cast<float*>(values.data()), {rows, columns}, torch::kFloat).to(device_, torch::kFloat, false, true);
  }
  Index index(std::span<const std::int32_t> numbers) const {
    return torch::from_blob(const_cast<std::int32_t*>(numbers.data()), {static_cast<std::int64_t>(numbers.size())}, torch::kInt)
        .to(device_, torch::kInt, false, true);
  }
  Tensor linear(const nets::Path& path, const Tensor& x, int) { return torch::linear(x, at(path / "weight"), at(path / "bias")); }
  Tensor batch_norm(const nets::Path& path, const Tensor& x) {
    if (mode_ == Mode::training && rule_.renormalises()) return batch_renorm(path, x);
    return torch::batch_norm(x, at(path / "weight"), at(path / "bias"), at(path / "running_mean"), at(path / "running_var"),
                             mode_ == Mode::training, rule_.momentum, nets::norm_epsilon, true);
  }
  Tensor relu(const Tensor& x) { return torch::relu(x); }
  Tensor subtract(const Tensor& x, const Tensor& y) { return x - y; }
  Tensor concat(std::initializer_list<Tensor> all) { return torch::cat(std::vector<Tensor>(all), 1); }
  Tensor rows(const Tensor& x, const Index& index) { return torch::index_select(x, 0, index); }
  Tensor max_by(const Tensor& x, const Index& offsets) {
    const std::int64_t segments = offsets.size(0) - 1;
    const Tensor segment = torch::repeat_interleave(counts_of(offsets)).unsqueeze(1).expand_as(x);
    return torch::zeros({segments, x.size(1)}, x.options()).scatter_reduce(0, segment, x, "amax", false);
  }
  Tensor mean_of(const Tensor& x, const Index& offsets, const Index& sources) {
    const Tensor counts = counts_of(offsets);
    const Tensor sums = torch::zeros({counts.size(0), x.size(1)}, x.options())
                            .index_add(0, torch::repeat_interleave(counts), torch::index_select(x, 0, sources));
    return sums / counts.unsqueeze(1);
  }
  Tensor attend(const Tensor& x, const Index& offsets, const Index& sources, int heads) {
    const Tensor segment = torch::repeat_interleave(counts_of(offsets));
    const Tensor blocks = x.view({x.size(0), heads, -1}), source = torch::index_select(blocks, 0, sources);  // (E,heads,width)
    const Tensor scores = (torch::index_select(blocks, 0, segment) * source).sum(2);
    const Tensor largest = max_by(scores.detach(), offsets);
    const Tensor shares = (scores - torch::index_select(largest, 0, segment)).exp();
    const Tensor totals = torch::zeros({x.size(0), heads}, x.options()).index_add(0, segment, shares);
    const Tensor sums = torch::zeros_like(blocks).index_add(0, segment, source * shares.unsqueeze(2));
    return (sums / totals.unsqueeze(2)).view_as(x);
  }

 protected:
  static Tensor counts_of(const Index& offsets) {
    const std::int64_t segments = offsets.size(0) - 1;
    return (offsets.narrow(0, 1, segments) - offsets.narrow(0, 0, segments)).to(torch::kLong);
  }
  // How far the batch's figures are from the running ones, as constants; the running ones move towards the batch's.
  struct Correction {
    Tensor stretch, offset;
  };
  Correction corrected(const nets::Path& path, const Tensor& x) {
    const torch::NoGradGuard constants;
    const auto [variance, mean] = torch::var_mean(x, {0}, false);
    Tensor running_mean = at(path / "running_mean"), running_var = at(path / "running_var");
    const Tensor usual = (running_var + nets::norm_epsilon).sqrt(), deviation = (variance + nets::norm_epsilon).sqrt();
    const Correction out{(deviation / usual).clamp(1.0 / rule_.largest_stretch, rule_.largest_stretch),
                         ((mean - running_mean) / usual).clamp(-rule_.largest_offset, rule_.largest_offset)};
    const double n = static_cast<double>(x.size(0)), unbias = n > 1.0 ? n / (n - 1.0) : 1.0;
    running_mean.mul_(1.0 - rule_.momentum).add_(mean, rule_.momentum);
    running_var.mul_(1.0 - rule_.momentum).add_(variance, rule_.momentum * unbias);
    return out;
  }
  Tensor batch_renorm(const nets::Path& path, const Tensor& x) {
    const Tensor mean = x.mean(0), deviation = (x.var(0, false) + nets::norm_epsilon).sqrt();
    const Correction r = corrected(path, x);
    return ((x - mean) / deviation * r.stretch + r.offset) * at(path / "weight") + at(path / "bias");
  }
  const Tensor& at(const nets::Path& path) const {
    const auto found = parameters_.find(path.name());
    if (found == parameters_.end()) throw Error("the network has no parameter '{}' among {} given", path.name(), parameters_.size());
    return found->second;
  }

  Parameters& parameters_;
  Mode mode_;
  torch::Device device_;
  NormRule rule_;
};

}  // namespace osteon::train
