// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <initializer_list>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "osteon/infer/folding.h"
#include "osteon/infer/parameters.h"
#include "osteon/nets/layers.h"
#include "osteon/tensor/edge_convolution.h"
#include "osteon/tensor/packed_mlp.h"
#include "osteon/tensor/tensor.h"

namespace osteon::infer {

// The product backend: runs a network on oneDNN with every restructuring that is exact (but for rounding).
// A layer is folded and packed when it is first run, and its parameters are forgotten. Two things are put off:
// * the normalisation that ends an MLP or an edge convolution: the layers that read the result have it folded in;
// * an MLP's rows: a maximum over them needs no storage for them (max_by), any other reader has them computed once.
// Several threads may run the network at the same time.
class Onednn {
 public:
  struct Value;
  struct Tensor {
    std::shared_ptr<Value> value;
  };
  struct Index {
    std::shared_ptr<const std::vector<std::int32_t>> numbers;
  };

  // Pre: precision is f32 or tensor::has_bf16().
  explicit Onednn(Parameters parameters, tensor::Precision precision = tensor::Precision::f32);
  ~Onednn();
  Onednn(const Onednn&) = delete;
  Onednn& operator=(const Onednn&) = delete;

  Tensor tensor(std::span<const float> values, int rows, int columns);
  Index index(std::span<const std::int32_t> numbers);
  Tensor linear(const nets::Path& path, const Tensor& x, int width);
  Tensor batch_norm(const nets::Path& path, const Tensor& x);
  Tensor relu(const Tensor& x);
  Tensor subtract(const Tensor& x, const Tensor& y);
  Tensor concat(std::initializer_list<Tensor> parts);
  Tensor rows(const Tensor& x, const Index& picked);
  Tensor max_by(const Tensor& x, const Index& offsets);
  Tensor mean_of(const Tensor& x, const Index& offsets, const Index& sources);
  Tensor attend(const Tensor& x, const Index& offsets, const Index& sources, int heads);

  // Composites that are faster as a whole: see nets/layers.h.
  Tensor linear_of(const nets::Path& path, const nets::Input<Onednn>& input, int width);
  Tensor mlp(const nets::Path& path, const nets::Input<Onednn>& input, std::initializer_list<int> widths);
  Tensor edge_conv(const nets::Path& path, const Tensor& x, const nets::Edges<Onednn>& edges, int width);

  Matrix matrix(const Tensor& x) const;

 private:
  struct Chain;
  struct Convolution;
  using Norm = std::shared_ptr<const Affine>;

  Norm norm(const nets::Path& path);
  const Chain& chain(const nets::Path& path, const nets::Input<Onednn>& input, std::size_t steps);
  const Chain& single(const nets::Path& path, const nets::Input<Onednn>& input);
  const Convolution& convolution(const nets::Path& path, const Value& x);

  std::mutex mutex_;  // of everything below
  Parameters parameters_;
  tensor::Precision precision_;
  std::map<std::string, Norm> norms_;
  std::map<std::string, std::unique_ptr<Chain>> chains_;
  std::map<std::string, std::unique_ptr<Convolution>> convolutions_;
};

}  // namespace osteon::infer
