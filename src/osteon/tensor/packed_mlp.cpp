// SPDX-License-Identifier: Apache-2.0
#include "osteon/tensor/packed_mlp.h"

#include <algorithm>
#include <cassert>
#include <limits>

#include "osteon/base/parallel.h"
#include "osteon/tensor/row_loops.h"

namespace osteon::tensor {
namespace {

constexpr int input_slot = 3, even_slot = 4, odd_slot = 5;  // thread_scratch; PackedLinear has 0..2 and 8

using Block = PackedMlp::Block;

std::vector<bool> multiplied_apart(std::span<const Block> blocks) {
  const bool some_own = std::ranges::any_of(blocks, [](const Block& b) { return b.reading == Reading::own_row; });
  std::vector<bool> apart;
  for (const Block& b : blocks) apart.push_back(some_own && b.reading == Reading::picked_row);
  return apart;
}

// The columns of `weights` that belong to the blocks for which apart == wanted, side by side.
Matrix columns_of(const Matrix& weights, std::span<const Block> blocks, const std::vector<bool>& apart, bool wanted) {
  Matrix out(weights.rows(), 0);
  Eigen::Index column = 0;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const auto width = static_cast<Eigen::Index>(blocks[i].columns);
    if (apart[i] == wanted) {
      out.conservativeResize(Eigen::NoChange, out.cols() + width);
      out.rightCols(width) = weights.middleCols(column, width);
    }
    column += width;
  }
  assert(column == weights.cols());
  return out;
}

std::vector<PackedLinear> pack_apart(const DenseLayer& layer, std::span<const Block> blocks, const std::vector<bool>& apart) {
  std::vector<PackedLinear> out;
  Eigen::Index column = 0;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const auto width = static_cast<Eigen::Index>(blocks[i].columns);
    if (apart[i]) out.emplace_back(layer.weights.middleCols(column, width), std::span<const float>(), Activation::none, layer.precision);
    column += width;
  }
  return out;
}

std::vector<PackedLinear> pack(std::span<const DenseLayer> layers) {
  std::vector<PackedLinear> out;
  for (const DenseLayer& layer : layers) out.emplace_back(layer.weights, layer.bias, layer.activation, layer.precision);
  return out;
}

// With columns multiplied apart the activation waits until they are added.
Activation activation_of_product(const DenseLayer& layer, const std::vector<bool>& apart) {
  return std::ranges::find(apart, true) == apart.end() ? layer.activation : Activation::none;
}

}  // namespace

// The input of one run: what is read row by row, and the finished products of what was multiplied apart.
struct PackedMlp::Prepared {
  std::vector<InputColumns> columns;
  struct Addend {
    Tensor product;
    std::span<const std::int32_t> picked;
  };
  std::vector<Addend> addends;
};

PackedMlp::PackedMlp(std::span<const Block> blocks, std::span<const DenseLayer> layers)
    : first_activation_(layers.front().activation),
      multiplied_apart_(multiplied_apart(blocks)),
      first_(columns_of(layers.front().weights, blocks, multiplied_apart_, false), layers.front().bias,
             activation_of_product(layers.front(), multiplied_apart_), layers.front().precision),
      apart_(pack_apart(layers.front(), blocks, multiplied_apart_)),
      later_(pack(layers.subspan(1))) {
  rows_at_a_time_ = first_.tile_rows();
  for (const PackedLinear& layer : later_) rows_at_a_time_ = std::max(rows_at_a_time_, layer.tile_rows());
}

PackedMlp::Prepared PackedMlp::prepare(std::span<const InputColumns> input) const {
  assert(input.size() == multiplied_apart_.size());
  Prepared out;
  for (std::size_t i = 0; i < input.size(); ++i) {
    if (!multiplied_apart_[i]) {
      out.columns.push_back(input[i]);
      continue;
    }
    const PackedLinear& multiply = apart_[out.addends.size()];
    Tensor product(input[i].values.rows(), multiply.outputs());
    parallel_for(product.rows(), multiply.tile_rows(), [&](std::size_t begin, std::size_t end) {
      multiply(input[i].values.row(begin).data(), end - begin, product.row(begin).data());
    });
    out.addends.push_back({product, *input[i].picked});
  }
  return out;
}

// The rows begin..end-1 of the columns that are read row by row, dense.
const float* PackedMlp::assemble(const Prepared& input, std::size_t begin, std::size_t end) const {
  const InputColumns& only = input.columns.front();
  if (input.columns.size() == 1 && !only.picked) return only.values.row(begin).data();
  const std::size_t width = first_.inputs();
  float* const dense = thread_scratch(input_slot, (end - begin) * width);
  std::size_t column = 0;
  for (const InputColumns& part : input.columns) {
    const std::size_t n = part.values.columns();
    for (std::size_t r = begin; r < end; ++r) {
      const std::size_t from = part.picked ? static_cast<std::size_t>((*part.picked)[r]) : r;
      std::copy_n(part.values.row(from).data(), n, dense + (r - begin) * width + column);
    }
    column += n;
  }
  assert(column == width);
  return dense;
}

void PackedMlp::run_rows(const Prepared& input, std::size_t begin, std::size_t end, float* out) const {
  const std::size_t rows = end - begin;
  auto target = [&](std::size_t layer, std::size_t width) {
    return layer == later_.size() ? out : thread_scratch(layer % 2 == 0 ? even_slot : odd_slot, rows * width);
  };
  float* x = target(0, first_.outputs());
  first_(assemble(input, begin, end), rows, x);
  for (std::size_t i = 0; i < input.addends.size(); ++i) {
    const bool last = i + 1 == input.addends.size();
    const auto& [product, picked] = input.addends[i];
    add_gathered(x, first_.outputs(), product.data(), picked.subspan(begin, rows), last ? first_activation_ : Activation::none);
  }
  for (std::size_t i = 0; i < later_.size(); ++i) {
    float* const y = target(i + 1, later_[i].outputs());
    later_[i](x, rows, y);
    x = y;
  }
}

Tensor PackedMlp::operator()(std::span<const InputColumns> input, std::size_t rows) const {
  Tensor out(rows, outputs());
  const Prepared prepared = prepare(input);
  parallel_for(rows, rows_at_a_time_,
               [&](std::size_t begin, std::size_t end) { run_rows(prepared, begin, end, out.data() + begin * out.columns()); });
  return out;
}

Tensor PackedMlp::max_by(std::span<const InputColumns> input, std::span<const std::int32_t> offsets, std::span<const float> scale,
                         std::span<const float> shift) const {
  struct Piece {
    std::size_t segment, begin, end;
  };
  std::vector<Piece> pieces;
  for (std::size_t s = 0; s + 1 < offsets.size(); ++s) {
    const auto first = static_cast<std::size_t>(offsets[s]), last = static_cast<std::size_t>(offsets[s + 1]);
    assert(first < last);
    for (std::size_t r = first; r < last; r += rows_at_a_time_) pieces.push_back({s, r, std::min(r + rows_at_a_time_, last)});
  }

  const std::size_t width = outputs();
  const Prepared prepared = prepare(input);
  Tensor of_pieces(pieces.size(), width);
  parallel_for(pieces.size(), 1, [&](std::size_t k, std::size_t) {
    const Piece& piece = pieces[k];
    const std::size_t rows = piece.end - piece.begin;
    float* const y = thread_scratch(later_.size() % 2 == 0 ? even_slot : odd_slot, rows * width);
    run_rows(prepared, piece.begin, piece.end, y);
    max_of_rows(y, rows, width, scale.data(), shift.data(), of_pieces.row(k).data());
  });

  Tensor out(offsets.size() - 1, width);
  std::fill_n(out.data(), out.rows() * width, -std::numeric_limits<float>::infinity());
  for (std::size_t k = 0; k < pieces.size(); ++k) {
    const auto segment = static_cast<std::int32_t>(pieces[k].segment);
    max_into(of_pieces.row(k).data(), {&segment, 1}, 0, width, out.data());
  }
  return out;
}

}  // namespace osteon::tensor
