// SPDX-License-Identifier: Apache-2.0
#include "osteon/infer/onednn_backend.h"

#include <algorithm>
#include <cassert>

#include "osteon/tensor/loops.h"
#include "osteon/tensor/parallel_loops.h"
#include "osteon/tensor/row_loops.h"

namespace osteon::infer {

namespace loops = tensor::loops;
using nets::Path;
using tensor::Activation;
using Input = nets::Input<Onednn>;

// Layers one after the other, packed, and the normalisation that comes after them (empty: none).
struct Onednn::Chain {
  std::vector<Norm> folded;  // of each part of the input: what the weights expect not to have been applied
  tensor::PackedMlp packed;
  Norm after;
};

struct Onednn::Convolution {
  Norm folded;
  tensor::EdgeConvolution packed;
  Norm after;
};

// What a Tensor stands for: `after` applied to the numbers, or to what the chain gives for the input.
struct Onednn::Value {
  struct Deferred {
    const tensor::PackedMlp* mlp;
    Input input;
    std::vector<Index> picked;  // keeps alive the indices that the input points to
  };

  std::size_t rows, columns;
  Norm after;
  std::optional<tensor::Tensor> numbers;
  std::optional<Deferred> deferred;

  const tensor::Tensor& stored();  // the numbers before `after`, computed if they were put off
  tensor::Tensor applied();        // with `after`
};

namespace {

std::vector<tensor::InputColumns> stored_columns(const Input& input) {
  std::vector<tensor::InputColumns> out;
  for (const auto& part : input) {
    std::optional<std::span<const std::int32_t>> picked;
    if (part.rows) picked = *part.rows->numbers;
    out.push_back({part.values.value->stored(), picked});
  }
  return out;
}

std::size_t rows_of(const Input& input) {
  const auto& part = input.front();
  return part.rows ? part.rows->numbers->size() : part.values.value->rows;
}

Onednn::Tensor made(tensor::Tensor numbers, std::shared_ptr<const Affine> after = nullptr) {
  const std::size_t rows = numbers.rows(), columns = numbers.columns();
  return {std::make_shared<Onednn::Value>(Onednn::Value{rows, columns, std::move(after), std::move(numbers), {}})};
}

constexpr std::size_t kLongSegment = 64;  // rows that fill a product: tensor/packed_linear.cpp

Affine identity(std::size_t columns) { return {std::vector<float>(columns, 1.0f), std::vector<float>(columns, 0.0f)}; }

Affine affine_of(const std::shared_ptr<const Affine>& norm, std::size_t columns) { return norm ? *norm : identity(columns); }

// The normalisations still to be applied to the parts, side by side.
Affine affine_of(const Input& input) {
  Affine out;
  for (const auto& part : input) {
    const Affine one = affine_of(part.values.value->after, part.values.value->columns);
    out.scale.insert(out.scale.end(), one.scale.begin(), one.scale.end());
    out.shift.insert(out.shift.end(), one.shift.begin(), one.shift.end());
  }
  return out;
}

std::vector<std::shared_ptr<const Affine>> norms_of(const Input& input) {
  std::vector<std::shared_ptr<const Affine>> out;
  for (const auto& part : input) out.push_back(part.values.value->after);
  return out;
}

tensor::PackedMlp packed(const Input& input, std::span<const tensor::DenseLayer> layers) {
  std::vector<tensor::PackedMlp::Block> blocks;
  for (const auto& part : input)
    blocks.push_back({part.values.value->columns, part.rows ? tensor::Reading::picked_row : tensor::Reading::own_row});
  return {blocks, layers};
}

}  // namespace

const tensor::Tensor& Onednn::Value::stored() {
  if (!numbers) {
    numbers = (*deferred->mlp)(stored_columns(deferred->input), rows);
    deferred.reset();
  }
  return *numbers;
}

tensor::Tensor Onednn::Value::applied() { return after ? tensor::scale_shift(stored(), after->scale, after->shift) : stored(); }

Onednn::Onednn(Parameters parameters, tensor::Precision precision) : parameters_(std::move(parameters)), precision_(precision) {}
Onednn::~Onednn() = default;

// Pre: the mutex is held, here and in the next three.
Onednn::Norm Onednn::norm(const Path& path) {
  Norm& known = norms_[path.name()];
  if (!known) known = std::make_shared<const Affine>(normalization(parameters_, path));
  return known;
}

const Onednn::Chain& Onednn::chain(const Path& path, const Input& input, std::size_t steps) {
  std::unique_ptr<Chain>& known = chains_[path.name()];
  if (!known) {
    std::vector<tensor::DenseLayer> layers;
    Affine before = affine_of(input);
    for (int step = 0; step < static_cast<int>(steps); ++step) {
      layers.push_back(folded_linear(parameters_, path / step / "linear", before, Activation::relu, precision_));
      before = *norm(path / step / "norm");
    }
    known = std::make_unique<Chain>(Chain{norms_of(input), packed(input, layers), norm(path / static_cast<int>(steps - 1) / "norm")});
    parameters_.forget(path);
  }
  return *known;
}

const Onednn::Chain& Onednn::single(const Path& path, const Input& input) {
  std::unique_ptr<Chain>& known = chains_[path.name()];
  if (!known) {
    const tensor::DenseLayer layer = folded_linear(parameters_, path, affine_of(input), Activation::none, precision_);
    known = std::make_unique<Chain>(Chain{norms_of(input), packed(input, {&layer, 1}), nullptr});
    parameters_.forget(path);
  }
  return *known;
}

const Onednn::Convolution& Onednn::convolution(const Path& path, const Value& x) {
  std::unique_ptr<Convolution>& known = convolutions_[path.name()];
  if (!known) {
    tensor::EdgeConvolution layer(folded_edge_convolution(parameters_, path, affine_of(x.after, x.columns), precision_));
    known = std::make_unique<Convolution>(Convolution{x.after, std::move(layer), norm(path / 1 / "norm")});
    parameters_.forget(path);
  }
  return *known;
}

Onednn::Tensor Onednn::tensor(std::span<const float> values, int rows, int columns) {
  tensor::Tensor out(static_cast<std::size_t>(rows), static_cast<std::size_t>(columns));
  assert(values.size() == out.rows() * out.columns());
  std::ranges::copy(values, out.data());
  return made(std::move(out));
}

Onednn::Index Onednn::index(std::span<const std::int32_t> numbers) {
  return {std::make_shared<const std::vector<std::int32_t>>(numbers.begin(), numbers.end())};
}

Onednn::Tensor Onednn::linear(const Path& path, const Tensor& x, int width) { return linear_of(path, {x}, width); }

Onednn::Tensor Onednn::linear_of(const Path& path, const Input& input, [[maybe_unused]] int width) {
  std::unique_lock lock(mutex_);
  const Chain& layer = single(path, input);
  lock.unlock();
  assert(layer.folded == norms_of(input) && layer.packed.outputs() == static_cast<std::size_t>(width));
  return made(layer.packed(stored_columns(input), rows_of(input)));
}

Onednn::Tensor Onednn::mlp(const Path& path, const Input& input, std::initializer_list<int> widths) {
  std::unique_lock lock(mutex_);
  const Chain& layers = chain(path, input, widths.size());
  lock.unlock();
  assert(layers.folded == norms_of(input) && layers.packed.outputs() == static_cast<std::size_t>(widths.end()[-1]));

  Value::Deferred deferred{&layers.packed, input, {}};
  deferred.picked.reserve(input.size());
  for (auto& part : deferred.input)
    if (part.rows) part.rows = &deferred.picked.emplace_back(*part.rows);
  return {std::make_shared<Value>(Value{rows_of(input), layers.packed.outputs(), layers.after, {}, std::move(deferred)})};
}

Onednn::Tensor Onednn::edge_conv(const Path& path, const Tensor& x, const nets::Edges<Onednn>& edges, [[maybe_unused]] int width) {
  std::unique_lock lock(mutex_);
  const Convolution& layer = convolution(path, *x.value);
  lock.unlock();
  assert(layer.folded == x.value->after);
  tensor::Tensor out = layer.packed(x.value->stored(), {*edges.offsets.numbers, *edges.sources.numbers, *edges.receivers.numbers});
  assert(out.columns() == static_cast<std::size_t>(width));
  return made(std::move(out), layer.after);
}

Onednn::Tensor Onednn::batch_norm(const Path& path, const Tensor& x) {
  const std::lock_guard lock(mutex_);
  return made(x.value->applied(), norm(path));
}

Onednn::Tensor Onednn::relu(const Tensor& x) { return made(tensor::relu(x.value->applied())); }

Onednn::Tensor Onednn::subtract(const Tensor& x, const Tensor& y) { return made(loops::subtract(x.value->applied(), y.value->applied())); }

Onednn::Tensor Onednn::concat(std::initializer_list<Tensor> parts) {
  std::vector<tensor::Tensor> applied;
  for (const Tensor& part : parts) applied.push_back(part.value->applied());
  return made(loops::concat(applied));
}

Onednn::Tensor Onednn::rows(const Tensor& x, const Index& picked) {
  return made(tensor::rows(x.value->stored(), *picked.numbers), x.value->after);
}

Onednn::Tensor Onednn::max_by(const Tensor& x, const Index& offsets) {
  Value& value = *x.value;
  const Affine after = affine_of(value.after, value.columns);
  const auto& segments = *offsets.numbers;
  // A chain without storage computes every segment by itself: many short ones would each be a product that is hardly filled.
  const bool short_segments = value.rows < kLongSegment * (segments.size() - 1);
  if (value.numbers || short_segments) return made(tensor::max_by(value.stored(), segments, after.scale, after.shift));
  return made(value.deferred->mlp->max_by(stored_columns(value.deferred->input), segments, after.scale, after.shift));
}

// A mean of normalised rows is the normalised mean.
Onednn::Tensor Onednn::mean_of(const Tensor& x, const Index& offsets, const Index& sources) {
  return made(tensor::mean_of(x.value->stored(), *offsets.numbers, *sources.numbers), x.value->after);
}

Onednn::Tensor Onednn::attend(const Tensor& x, const Index& offsets, const Index& sources, int heads) {
  return made(tensor::attend(x.value->applied(), *offsets.numbers, *sources.numbers, static_cast<std::size_t>(heads)));
}

Matrix Onednn::matrix(const Tensor& x) const { return x.value->applied().matrix(); }

}  // namespace osteon::infer
