// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "osteon/infer/networks.h"

// The work of a network: how many multiplications and additions the products take that Onednn runs it by.
namespace osteon::bench {

using infer::NetworkInput;
using nets::rignet::Network;

// Counts the multiplications and additions of the products of a network as Onednn runs it.
class Counter {
 public:
  struct Tensor {
    double rows = 0, columns = 0;
  };
  struct Index {
    double count = 0;
  };
  double flop = 0;

  Tensor tensor(std::span<const float>, int rows, int columns) { return {double(rows), double(columns)}; }
  Index index(std::span<const std::int32_t> numbers) { return {double(numbers.size())}; }
  Tensor linear(const nets::Path& path, const Tensor& x, int width) { return linear_of(path, {x}, width); }
  Tensor linear_of(const nets::Path&, const nets::Input<Counter>& input, int width) {
    double rows = input.front().rows ? input.front().rows->count : input.front().values.rows;
    for (const auto& part : input) flop += 2 * part.values.rows * part.values.columns * width;
    return {rows, double(width)};
  }
  Tensor edge_conv(const nets::Path&, const Tensor& x, const nets::Edges<Counter>& edges, int width) {
    flop += 2 * (x.rows * x.columns * 2 * width + edges.sources.count * width * width);
    return {x.rows, double(width)};
  }
  Tensor batch_norm(const nets::Path&, const Tensor& x) { return x; }
  Tensor relu(const Tensor& x) { return x; }
  Tensor subtract(const Tensor& x, const Tensor&) { return x; }
  Tensor concat(std::initializer_list<Tensor> parts) {
    Tensor out{parts.begin()->rows, 0};
    for (const Tensor& part : parts) out.columns += part.columns;
    return out;
  }
  Tensor rows(const Tensor& x, const Index& picked) { return {picked.count, x.columns}; }
  Tensor max_by(const Tensor& x, const Index& offsets) { return {offsets.count - 1, x.columns}; }
  Tensor mean_of(const Tensor& x, const Index& offsets, const Index&) { return {offsets.count - 1, x.columns}; }
  Tensor attend(const Tensor& x, const Index&, const Index& sources, int) {
    flop += 4 * sources.count * x.columns;  // a dot product and a weighted sum
    return x;
  }
};

inline double flop_of(Network network, const NetworkInput& input) {
  Counter b;
  const auto mesh = nets::on_backend(b, input.mesh);
  const auto joints = nets::on_backend(b, *input.joints);
  switch (network) {
    case Network::joints:
      nets::rignet::joint_net(b, mesh);
      break;
    case Network::attention:
      nets::rignet::mask_net(b, mesh);
      break;
    case Network::votes:
      nets::vote_net(b, mesh, nets::on_backend(b, *input.votes));
      break;
    case Network::bones:
      nets::rignet::bone_net(b, mesh, joints, nets::on_backend(b, *input.pairs));
      break;
    case Network::root:
      nets::rignet::root_net(b, mesh, joints);
      break;
    case Network::tree:
      nets::tree_net(b, joints, nets::on_backend(b, *input.tree));
      break;
    case Network::skin:
      nets::rignet::skin_net(b, mesh, b.tensor(input.skin_features, input.mesh.batch.rows(), nets::rignet::skin_inputs));
      break;
    case Network::bind:
      nets::bind_net(b, mesh, nets::on_backend(b, *input.choices));
      break;
    case Network::neuroskinning:
      nets::neuroskinning::joint_choice_net(b, mesh, nets::on_backend(b, *input.neuro));
      break;
    case Network::neuroskinning_2019:
      nets::neuroskinning::slot_net(b, mesh, nets::on_backend(b, *input.neuro));
      break;
  }
  return b.flop;
}

}  // namespace osteon::bench
