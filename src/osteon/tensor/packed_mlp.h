// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "osteon/tensor/packed_linear.h"
#include "osteon/tensor/tensor.h"

namespace osteon::tensor {

// A linear layer before packing; weights (outputs, inputs), bias (outputs) or empty.
struct DenseLayer {
  Matrix weights;
  std::vector<float> bias;
  Activation activation = Activation::none;
  Precision precision = Precision::f32;
};

enum class Reading { own_row, picked_row };

// Some columns of the input: the rows of `values`, or the rows that `picked` names (one number for each row of the result).
struct InputColumns {
  Tensor values;
  std::optional<std::span<const std::int32_t>> picked;
};

// Linear layers one after the other, computed for a block of rows at a time: between the layers a block stays in the cache, and the
// columns that make up the input are put side by side only there. Picked columns are multiplied once per row of `values`, not once
// per row of the result: W [g; l] = Wg g + Wl l.
class PackedMlp {
 public:
  struct Block {
    std::size_t columns;
    Reading reading;
  };
  // The blocks lie side by side in the first layer's weights. Pre: there is a layer and a block; widths fit together.
  PackedMlp(std::span<const Block> blocks, std::span<const DenseLayer> layers);

  std::size_t outputs() const { return later_.empty() ? first_.outputs() : later_.back().outputs(); }
  // (rows, outputs). Pre: `input` has the blocks of the constructor.
  Tensor operator()(std::span<const InputColumns> input, std::size_t rows) const;
  // Row s is the maximum of scale * y + shift over the rows y = offsets[s] .. offsets[s+1]-1 of what operator() gives, without storing
  // that. Pre: every segment has a row.
  Tensor max_by(std::span<const InputColumns> input, std::span<const std::int32_t> offsets, std::span<const float> scale,
                std::span<const float> shift) const;

 private:
  struct Prepared;
  Prepared prepare(std::span<const InputColumns> input) const;
  const float* assemble(const Prepared& input, std::size_t begin, std::size_t end) const;
  void run_rows(const Prepared& input, std::size_t begin, std::size_t end, float* out) const;

  std::size_t rows_at_a_time_;
  Activation first_activation_;
  std::vector<bool> multiplied_apart_;  // for each block: picked, and not the only kind there is
  PackedLinear first_;
  std::vector<PackedLinear> apart_;  // of the blocks multiplied apart, in order
  std::vector<PackedLinear> later_;
};

}  // namespace osteon::tensor
