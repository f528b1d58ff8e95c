// SPDX-License-Identifier: Apache-2.0
#include "osteon/train/fused_ops.h"

#include <ATen/Parallel.h>

#include <algorithm>
#include <utility>

#include "osteon/train/edge_layer.h"
#include "osteon/train/gemm.h"
#include "osteon/train/row_loops.h"

namespace osteon::train {
namespace {

using torch::Tensor;
using torch::autograd::AutogradContext;
using torch::autograd::variable_list;

// Keeps what is no tensor between forward and backward.
template <class T>
struct Kept : torch::CustomClassHolder {
  explicit Kept(T v) : value(std::move(v)) {}
  T value;
};

template <class T>
void keep(AutogradContext* context, T value) {
  c10::intrusive_ptr<torch::CustomClassHolder> holder = c10::make_intrusive<Kept<T>>(std::move(value));
  context->saved_data["kept"] = c10::IValue::make_capsule(std::move(holder));
}

template <class T>
T& kept(AutogradContext* context) {
  return static_cast<Kept<T>*>(context->saved_data["kept"].toCapsule().get())->value;
}

MatrixView view(const Tensor& x, Transposed transposed = Transposed::no) { return {x.data_ptr<float>(), x.stride(0), transposed}; }

Tensor contiguous_columns(const Tensor& x) { return x.stride(1) == 1 ? x : x.contiguous(); }

// c (m,n) = a b + beta c on all threads: blocks of rows of c that do not depend on how many threads there are. At least two blocks: a
// product on its own is shared out by oneDNN, which adds up in another order for each number of threads.
void parallel_gemm(std::int64_t m, std::int64_t n, std::int64_t k, const MatrixView& a, const MatrixView& b, float beta, float* c) {
  constexpr std::int64_t most = 512;  // rows: enough to repay packing b again
  const std::int64_t block = std::clamp<std::int64_t>((m + 1) / 2, 1, most);
  at::parallel_for(0, (m + block - 1) / block, 1, [&](std::int64_t begin, std::int64_t end) {
    for (std::int64_t i = begin; i < end; ++i) {
      const std::int64_t first = i * block, rows = std::min(block, m - first);
      const std::int64_t skipped = a.transposed == Transposed::yes ? first : first * a.row_stride;
      gemm(rows, n, k, {a.data + skipped, a.row_stride, a.transposed}, b, beta, c + first * n, n);
    }
  });
}

Tensor sum_of_rows(const Tensor& x) {
  GroupSums sums(x.size(1));
  for_row_groups(x.size(0), [&](int group, std::int64_t first, std::int64_t last) {
    column_sums(x.data_ptr<float>() + first * x.size(1), last - first, x.size(1), sums.of(group));
  });
  return to_tensor(sums.total());
}

// dx[index[i]] += dy[i]
void add_to_rows(const Tensor& dy, const Tensor& index, Tensor& dx) {
  const std::int32_t* row = index.data_ptr<std::int32_t>();
  for (std::int64_t i = 0; i < dy.size(0); ++i)
    column_sums(dy.data_ptr<float>() + i * dy.size(1), 1, dy.size(1), dx.data_ptr<float>() + row[i] * dy.size(1));
}

// y = start + sum of x_i W_i^T. The list holds x_1 .. x_k, W_1 .. W_k. What each row starts with: row index[i] of `start` (S,n); or `start`
// (n) itself, where there is no index.
struct LinearBlocks : torch::autograd::Function<LinearBlocks> {
  static Tensor forward(AutogradContext* context, at::TensorList list, const Tensor& start, const Tensor& index) {
    variable_list saved;
    for (const Tensor& x : list) saved.push_back(contiguous_columns(x));
    const std::size_t parts = saved.size() / 2;
    const std::int64_t rows = saved[0].size(0), width = start.size(-1);
    const Tensor from = start.contiguous();
    Tensor y = torch::empty({rows, width});
    for_row_groups(rows, [&](int, std::int64_t first, std::int64_t last) {
      for (std::int64_t i = first; i < last; ++i)
        std::copy_n(from.data_ptr<float>() + (start.dim() == 2 ? index.data_ptr<std::int32_t>()[i] * width : 0), width,
                    y.data_ptr<float>() + i * width);
    });
    for (std::size_t i = 0; i < parts; ++i)
      parallel_gemm(rows, width, saved[i].size(1), view(saved[i]), view(saved[parts + i], Transposed::yes), 1.0f, y.data_ptr<float>());
    saved.push_back(index);
    context->save_for_backward(std::move(saved));
    context->saved_data["starts"] = start.dim() == 1 ? 0 : start.size(0);
    return y;
  }

  static variable_list backward(AutogradContext* context, variable_list gradients) {
    const Tensor dy = gradients[0].contiguous();
    const variable_list saved = context->get_saved_variables();
    const std::size_t parts = saved.size() / 2;
    const std::int64_t rows = dy.size(0), width = dy.size(1), starts = context->saved_data["starts"].toInt();
    variable_list out(2 * parts + 2);
    for (std::size_t i = 0; i < parts; ++i) {
      const Tensor &x = saved[i], &w = saved[parts + i];
      const std::int64_t columns = x.size(1);
      if (context->needs_input_grad(i)) {
        out[i] = torch::empty({rows, columns});
        parallel_gemm(rows, columns, width, view(dy), view(w), 0.0f, out[i].data_ptr<float>());
      }
      if (context->needs_input_grad(parts + i)) {
        out[parts + i] = torch::empty({width, columns});
        parallel_gemm(width, columns, rows, view(dy, Transposed::yes), view(x), 0.0f, out[parts + i].data_ptr<float>());
      }
    }
    Tensor& d_start = out[2 * parts];
    d_start = starts > 0 ? torch::zeros({starts, width}) : sum_of_rows(dy);
    if (starts > 0) add_to_rows(dy, saved.back(), d_start);
    return out;
  }
};

struct PickedRows : torch::autograd::Function<PickedRows> {
  static Tensor forward(AutogradContext* context, const Tensor& x, const Tensor& index) {
    context->save_for_backward({index});
    context->saved_data["rows"] = x.size(0);
    return x.index_select(0, index);
  }

  static variable_list backward(AutogradContext* context, variable_list gradients) {
    const Tensor dy = gradients[0].contiguous(), index = context->get_saved_variables()[0];
    Tensor dx = torch::zeros({context->saved_data["rows"].toInt(), dy.size(1)});
    add_to_rows(dy, index, dx);
    return {dx, Tensor()};
  }
};

struct SegmentMax : torch::autograd::Function<SegmentMax> {
  static Tensor forward(AutogradContext* context, const Tensor& x, const Tensor& offsets) {
    const std::int64_t segments = offsets.size(0) - 1, width = x.size(1);
    const Tensor values = x.contiguous();
    Tensor best = torch::empty({segments, width}), arg = torch::empty({segments, width}, torch::kInt);
    for (std::int64_t s = 0; s < segments; ++s)
      row_maximum({values.data_ptr<float>(), width}, offsets.data_ptr<std::int32_t>()[s], offsets.data_ptr<std::int32_t>()[s + 1],
                  best.data_ptr<float>() + s * width, arg.data_ptr<std::int32_t>() + s * width);
    context->save_for_backward({arg});
    context->saved_data["rows"] = x.size(0);
    return best;
  }

  static variable_list backward(AutogradContext* context, variable_list gradients) {
    const Tensor dy = gradients[0].contiguous(), arg = context->get_saved_variables()[0];
    Tensor dx = torch::zeros({context->saved_data["rows"].toInt(), dy.size(1)});
    const float* g = dy.data_ptr<float>();
    const std::int32_t* row = arg.data_ptr<std::int32_t>();
    for (std::int64_t i = 0; i < dy.numel(); ++i) dx.data_ptr<float>()[row[i] * dy.size(1) + i % dy.size(1)] += g[i];
    return {dx, Tensor()};
  }
};

Norm norm_of(const Tensor& x, const FusedNorm& norm) {
  if (norm.mode == Mode::use) return stored_norm_of(norm.parameters);
  GroupSums sum(x.size(1)), squares(x.size(1));
  for_row_groups(x.size(0), [&](int group, std::int64_t first, std::int64_t last) {
    relu_moments(x.data_ptr<float>() + first * x.size(1), last - first, x.size(1), sum.of(group), squares.of(group));
  });
  return batch_norm_of(sum, squares, x.size(0), norm.parameters, norm.rule);
}

struct ReluNorm : torch::autograd::Function<ReluNorm> {
  static Tensor forward(AutogradContext* context, const Tensor& x, const Tensor&, const Tensor&, const FusedNorm& parameters) {
    Norm norm = norm_of(x, parameters);
    Tensor y = torch::empty_like(x);
    const std::int64_t width = x.size(1);
    for_row_groups(x.size(0), [&](int, std::int64_t first, std::int64_t last) {
      relu_affine(x.data_ptr<float>() + first * width, last - first, width, norm.scale.data(), norm.shift.data(),
                  y.data_ptr<float>() + first * width);
    });
    context->save_for_backward({x});
    keep(context, std::move(norm));
    return y;
  }

  static variable_list backward(AutogradContext* context, variable_list gradients) {
    const Tensor dy = gradients[0].contiguous(), x = context->get_saved_variables()[0];
    const Norm& norm = kept<Norm>(context);
    const std::int64_t width = x.size(1);
    GroupSums sum(width), product(width);
    for_row_groups(x.size(0), [&](int group, std::int64_t first, std::int64_t last) {
      relu_affine_sums(x.data_ptr<float>() + first * width, dy.data_ptr<float>() + first * width, last - first, width, sum.of(group),
                       product.of(group));
    });
    const NormGradient gradient = norm_gradient(norm, sum.total(), product.total(), x.size(0));
    Tensor dx = torch::empty_like(x);
    for_row_groups(x.size(0), [&](int, std::int64_t first, std::int64_t last) {
      relu_affine_backward(x.data_ptr<float>() + first * width, dy.data_ptr<float>() + first * width, last - first, width,
                           {norm.scale.data(), gradient.constant.data(), gradient.slope.data()}, dx.data_ptr<float>() + first * width);
    });
    return {dx, gradient.weight, gradient.bias, Tensor()};
  }
};

struct EdgeLayerState {
  EdgeIndices edges;
  EdgeLayerParameters parameters;
  EdgeLayerMemory memory;
};

// The parameters come as tensors too, so that autograd sees them: weight, bias, those of norm1, those of norm2.
struct EdgeLayer : torch::autograd::Function<EdgeLayer> {
  static Tensor forward(AutogradContext* context, const Tensor& terms, at::TensorList, const EdgeIndices& edges,
                        const EdgeLayerParameters& parameters, const NormRule& rule) {
    EdgeLayerState state{edges, parameters, {}};
    Tensor out = edge_layer_train(terms, edges, parameters, rule, state.memory);
    keep(context, std::move(state));
    return out;
  }

  static variable_list backward(AutogradContext* context, variable_list gradients) {
    EdgeLayerState& state = kept<EdgeLayerState>(context);
    EdgeLayerGradients d = edge_layer_backward(gradients[0].contiguous(), state.edges, state.parameters, state.memory);
    return {d.terms, d.weight, d.bias, d.norm1_weight, d.norm1_bias, d.norm2_weight, d.norm2_bias, Tensor(), Tensor(), Tensor()};
  }
};

}  // namespace

Tensor linear_blocks(const std::vector<Tensor>& inputs, const std::vector<Tensor>& weights, const Tensor& start, const Tensor& index) {
  std::vector<Tensor> list = inputs;
  list.insert(list.end(), weights.begin(), weights.end());
  return LinearBlocks::apply(at::TensorList(list), start,
                             index.defined() ? index : torch::empty({0}, at::kInt));  // an op needs all its inputs
}

Tensor picked_rows(const Tensor& x, const Tensor& index) { return PickedRows::apply(x, index); }

Tensor segment_max(const Tensor& x, const Tensor& offsets) { return SegmentMax::apply(x, offsets); }

Tensor relu_norm(const Tensor& x, const FusedNorm& norm) {
  return ReluNorm::apply(x.contiguous(), norm.parameters.weight, norm.parameters.bias, norm);
}

Tensor edge_layer(const Tensor& terms, const nets::Edges<TorchOps>& edges, const FusedEdgeLayer& layer) {
  const EdgeIndices indices{edges.offsets, edges.sources};
  const EdgeLayerParameters parameters{layer.weight, layer.bias, layer.norm1.parameters, layer.norm2.parameters};
  if (layer.norm1.mode == Mode::use) return edge_layer_use(terms.contiguous(), indices, parameters);
  const std::vector<Tensor> trained{
      layer.weight, layer.bias, parameters.norm1.weight, parameters.norm1.bias, parameters.norm2.weight, parameters.norm2.bias};
  return EdgeLayer::apply(terms.contiguous(), at::TensorList(trained), indices, parameters, layer.norm1.rule);
}

Tensor FusedOps::linear_of(const nets::Path& path, const nets::Input<FusedOps>& input, int) {
  const Tensor &weight = at(path / "weight"), &bias = at(path / "bias");
  std::vector<Tensor> inputs, weights;
  std::vector<std::pair<Tensor, Index>> picked;  // products of parts of which rows are picked
  std::int64_t column = 0;
  for (const auto& part : input) {
    const std::int64_t columns = part.values.size(1);
    const Tensor block = weight.narrow(1, column, columns);
    column += columns;
    if (part.rows) {
      picked.emplace_back(linear_blocks({part.values}, {block}, picked.empty() ? bias : torch::zeros_like(bias)), *part.rows);
    } else {
      inputs.push_back(part.values);
      weights.push_back(block);
    }
  }
  if (picked.empty()) return linear_blocks(inputs, weights, bias);
  Tensor y = linear_blocks(inputs, weights, picked[0].first, picked[0].second);
  for (std::size_t i = 1; i < picked.size(); ++i) y = y + picked_rows(picked[i].first, picked[i].second);
  return y;
}

Tensor FusedOps::mlp(const nets::Path& path, const nets::Input<FusedOps>& input, std::initializer_list<int> widths) {
  int step = 0;
  nets::Input<FusedOps> x = input;
  for (const int width : widths) {
    const nets::Path here = path / step++;
    x = {relu_norm(here / "norm", linear_of(here / "linear", x, width))};
  }
  return x.front().values;
}

Tensor FusedOps::edge_conv(const nets::Path& path, const Tensor& x, const nets::Edges<FusedOps>& edges, int) {
  const nets::Path first = path / 0, second = path / 1;
  const Tensor &weight = at(first / "linear" / "weight"), &bias = at(first / "linear" / "bias");
  const std::int64_t columns = x.size(1);
  const Tensor of_receiver = weight.narrow(1, 0, columns), of_difference = weight.narrow(1, columns, columns);
  const Tensor both = torch::cat({of_receiver - of_difference, of_difference}, 0);
  const Tensor terms = linear_blocks({x}, {both}, torch::cat({bias, torch::zeros_like(bias)}));
  return edge_layer(terms, {edges.offsets, edges.sources, edges.receivers},
                    {at(second / "linear" / "weight"), at(second / "linear" / "bias"), norm(first / "norm"), norm(second / "norm")});
}

FusedNorm FusedOps::norm(const nets::Path& path) const {
  return {{at(path / "weight"), at(path / "bias"), at(path / "running_mean"), at(path / "running_var")}, mode_, rule_};
}

}  // namespace osteon::train
