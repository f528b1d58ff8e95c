// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/nets/layers.h"
#include "osteon/train/torch_ops.h"

namespace osteon::train {

// Autograd functions with hand-written gradients, CPU only. Their results do not depend on the number of threads.
// start + sum of inputs_i weights_i^T; start is the bias (n), or (S,n) with the row that each row starts with in `index`.
torch::Tensor linear_blocks(const std::vector<torch::Tensor>& inputs, const std::vector<torch::Tensor>& weights, const torch::Tensor& start,
                            const torch::Tensor& index = {});
torch::Tensor picked_rows(const torch::Tensor& x, const torch::Tensor& index);
torch::Tensor segment_max(const torch::Tensor& x, const torch::Tensor& offsets);

torch::Tensor segment_mean(const torch::Tensor& x, const torch::Tensor& offsets, const torch::Tensor& sources);
torch::Tensor graph_attention(const torch::Tensor& x, const torch::Tensor& offsets, const torch::Tensor& sources, std::int64_t heads);

struct FusedNorm {
  NormParameters parameters;
  Mode mode;
  NormRule rule;
};
torch::Tensor relu_norm(const torch::Tensor& x, const FusedNorm& norm);

struct FusedEdgeLayer {
  torch::Tensor weight, bias;
  FusedNorm norm1, norm2;
};
torch::Tensor edge_layer(const torch::Tensor& terms, const nets::Edges<TorchOps>& edges, const FusedEdgeLayer& layer);

// nets::Ops for training on the CPU: the same functions as TorchOps (see fused_ops_test), about five times as fast.
// The first layer of an edge convolution acts once per vertex: W1 [x_v, x_u - x_v] = (A - B) x_v + B x_u with W1 = [A | B].
class FusedOps : public TorchOps {
 public:
  FusedOps(Parameters& parameters, Mode mode, const NormRule& rule = {}) : TorchOps(parameters, mode, torch::kCPU, rule) {}

  Tensor linear(const nets::Path& path, const Tensor& x, int) { return linear_blocks({x}, {at(path / "weight")}, at(path / "bias")); }
  Tensor rows(const Tensor& x, const Index& index) { return picked_rows(x, index); }
  Tensor max_by(const Tensor& x, const Index& offsets) { return segment_max(x, offsets); }
  Tensor mean_of(const Tensor& x, const Index& offsets, const Index& sources) { return segment_mean(x, offsets, sources); }
  Tensor attend(const Tensor& x, const Index& offsets, const Index& sources, int heads) {
    return graph_attention(x, offsets, sources, heads);
  }
  Tensor relu_norm(const nets::Path& path, const Tensor& x) { return train::relu_norm(x, norm(path)); }
  Tensor linear_of(const nets::Path& path, const nets::Input<FusedOps>& input, int width);
  Tensor mlp(const nets::Path& path, const nets::Input<FusedOps>& input, std::initializer_list<int> widths);
  Tensor edge_conv(const nets::Path& path, const Tensor& x, const nets::Edges<FusedOps>& edges, int width);

 private:
  FusedNorm norm(const nets::Path& path) const;
};

}  // namespace osteon::train
