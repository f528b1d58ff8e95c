// SPDX-License-Identifier: Apache-2.0
#include "osteon/tensor/graph_attention.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

#include "osteon/base/parallel.h"
#include "osteon/tensor/row_loops.h"

namespace osteon::tensor {
namespace {

constexpr std::size_t kRowsPerTask = 64;

// Calls work(v, the sources of v) for all segments, on all cores.
template <class Work>
void for_each_segment(std::span<const std::int32_t> offsets, std::span<const std::int32_t> sources, const Work& work) {
  parallel_for(offsets.size() - 1, kRowsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t v = begin; v < end; ++v)
      work(v, sources.subspan(static_cast<std::size_t>(offsets[v]), static_cast<std::size_t>(offsets[v + 1] - offsets[v])));
  });
}

// Makes the scores of every head (heads after heads, one source after the other) a softmax over the sources.
void softmax(std::vector<float>& scores, std::size_t heads) {
  for (std::size_t head = 0; head < heads; ++head) {
    float largest = scores[head], total = 0.0f;
    for (std::size_t i = head; i < scores.size(); i += heads) largest = std::max(largest, scores[i]);
    for (std::size_t i = head; i < scores.size(); i += heads) total += scores[i] = std::exp(scores[i] - largest);
    for (std::size_t i = head; i < scores.size(); i += heads) scores[i] /= total;
  }
}

}  // namespace

Tensor mean_of(const Tensor& x, std::span<const std::int32_t> offsets, std::span<const std::int32_t> sources) {
  Tensor out(offsets.size() - 1, x.columns());
  for_each_segment(offsets, sources,
                   [&](std::size_t v, std::span<const std::int32_t> own) { mean_of_rows(x.data(), x.columns(), own, out.row(v).data()); });
  return out;
}

Tensor attend(const Tensor& x, std::span<const std::int32_t> offsets, std::span<const std::int32_t> sources, std::size_t heads) {
  assert(offsets.size() == x.rows() + 1 && x.columns() % (16 * heads) == 0);
  Tensor out(x.rows(), x.columns());
  for_each_segment(offsets, sources, [&](std::size_t v, std::span<const std::int32_t> own) {
    std::vector<float> scores(own.size() * heads);
    head_products(x.row(v).data(), x.data(), x.columns(), own, heads, scores.data());
    softmax(scores, heads);
    sum_of_heads(x.data(), x.columns(), own, heads, scores.data(), out.row(v).data());
  });
  return out;
}

}  // namespace osteon::tensor
