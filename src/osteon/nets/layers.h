// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <vector>

#include "osteon/nets/ops.h"

// The building blocks of the graph networks. Each is plain Ops; a backend that has a member of the same name and arguments (after the
// backend itself) is asked instead: linear_of, mlp, edge_conv, relu_norm. Such a member must compute the same function of the same
// parameters.
namespace osteon::nets {

// Directed edges, sorted by receiver; every vertex receives from itself too.
template <class B>
struct Edges {
  typename B::Index offsets;    // (V+1) the edges into vertex v are offsets[v] .. offsets[v+1]-1
  typename B::Index sources;    // (E) where the message comes from
  typename B::Index receivers;  // (E) where it goes: the row that the segment stands for, written out
};

// Some columns of a layer's input: the rows of `values`, or rows picked by `rows` (such as one row a mesh, for each of its vertices).
template <class B>
struct Columns {
  Columns(typename B::Tensor v) : values(std::move(v)) {}
  Columns(typename B::Tensor v, const typename B::Index& r) : values(std::move(v)), rows(&r) {}

  typename B::Tensor values;
  const typename B::Index* rows = nullptr;
};

// Columns side by side, as the input of a linear layer.
template <class B>
using Input = std::vector<Columns<B>>;

template <Ops B>
typename B::Tensor materialized(B& b, const Input<B>& input) {
  auto whole = [&](const Columns<B>& part) { return part.rows ? b.rows(part.values, *part.rows) : part.values; };
  typename B::Tensor all = whole(input.front());
  for (std::size_t i = 1; i < input.size(); ++i) {
    const typename B::Tensor next = whole(input[i]);
    all = b.concat({all, next});
  }
  return all;
}

// Linear layer over columns side by side. A backend's linear_of can multiply block by block (the blocks of the weight's columns are in
// the order of the input), and picked rows once per row of `values` instead of once per picked row.
template <Ops B>
typename B::Tensor linear(B& b, const Path& path, const Input<B>& input, int width) {
  if constexpr (requires { b.linear_of(path, input, width); })
    return b.linear_of(path, input, width);
  else
    return b.linear(path, materialized(b, input), width);
}

// ReLU, then the normalisation at `path`.
template <Ops B>
typename B::Tensor relu_norm(B& b, const Path& path, const typename B::Tensor& x) {
  if constexpr (requires { b.relu_norm(path, x); }) {
    return b.relu_norm(path, x);
  } else {
    const auto positive = b.relu(x);
    return b.batch_norm(path, positive);
  }
}

// For each width: Linear, ReLU, BatchNorm. The normalisation comes last in every step, also in the last (facts of the released code; the
// paper does not say). Parameters path.<step>.linear.*, path.<step>.norm.*
template <Ops B>
typename B::Tensor mlp(B& b, const Path& path, const Input<B>& input, std::initializer_list<int> widths) {
  if constexpr (requires { b.mlp(path, input, widths); }) {
    return b.mlp(path, input, widths);
  } else {
    int step = 0;
    Input<B> x = input;
    for (const int width : widths) {
      const Path here = path / step++;
      const auto linear_part = linear(b, here / "linear", x, width);
      const auto positive = b.relu(linear_part);
      x = {b.batch_norm(here / "norm", positive)};
    }
    return x.front().values;
  }
}

// max over the edges u -> v of MLP[2C, width, width]([x_v, x_u - x_v]): (V,C) -> (V,width).
// Edge convolution: Wang et al., Dynamic Graph CNN, TOG 2019; RigNet, equation 2.
template <Ops B>
typename B::Tensor edge_conv(B& b, const Path& path, const typename B::Tensor& x, const Edges<B>& edges, int width) {
  if constexpr (requires { b.edge_conv(path, x, edges, width); }) {
    return b.edge_conv(path, x, edges, width);
  } else {
    const auto receiver = b.rows(x, edges.receivers);
    const auto source = b.rows(x, edges.sources);
    const auto difference = b.subtract(source, receiver);
    const auto messages = mlp<B>(b, path, {receiver, difference}, {width, width});
    return b.max_by(messages, edges.offsets);
  }
}

}  // namespace osteon::nets
