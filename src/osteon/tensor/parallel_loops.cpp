// SPDX-License-Identifier: Apache-2.0
#include "osteon/tensor/parallel_loops.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "osteon/base/parallel.h"
#include "osteon/tensor/packed_linear.h"
#include "osteon/tensor/row_loops.h"

namespace osteon::tensor {
namespace {

constexpr std::size_t kRowsPerTask = 64;
constexpr int score_slot = 9;  // thread_scratch

// A tensor whose row r work(r, its floats) fills.
template <class Work>
Tensor filled(std::size_t rows, std::size_t columns, const Work& work) {
  Tensor out(rows, columns);
  parallel_for(rows, kRowsPerTask, [&](std::size_t begin, std::size_t end) {
    for (std::size_t r = begin; r < end; ++r) work(r, out.row(r).data());
  });
  return out;
}

std::span<const std::int32_t> segment(std::span<const std::int32_t> offsets, std::span<const std::int32_t> sources, std::size_t v) {
  return sources.subspan(static_cast<std::size_t>(offsets[v]), static_cast<std::size_t>(offsets[v + 1] - offsets[v]));
}

// Makes the scores of every head (heads after heads, one source after the other) a softmax over the sources.
void softmax(std::span<float> scores, std::size_t heads) {
  for (std::size_t head = 0; head < heads; ++head) {
    float largest = scores[head], total = 0.0f;
    for (std::size_t i = head; i < scores.size(); i += heads) largest = std::max(largest, scores[i]);
    for (std::size_t i = head; i < scores.size(); i += heads) total += scores[i] = std::exp(scores[i] - largest);
    for (std::size_t i = head; i < scores.size(); i += heads) scores[i] /= total;
  }
}

}  // namespace

Tensor relu(const Tensor& x) {
  return filled(x.rows(), x.columns(), [&](std::size_t r, float* out) { relu_of_row(x.row(r).data(), x.columns(), out); });
}

Tensor scale_shift(const Tensor& x, std::span<const float> scale, std::span<const float> shift) {
  return filled(x.rows(), x.columns(),
                [&](std::size_t r, float* out) { max_of_rows(x.row(r).data(), 1, x.columns(), scale.data(), shift.data(), out); });
}

Tensor rows(const Tensor& x, std::span<const std::int32_t> picked) {
  return filled(picked.size(), x.columns(),
                [&](std::size_t r, float* out) { std::ranges::copy(x.row(static_cast<std::size_t>(picked[r])), out); });
}

Tensor mean_of(const Tensor& x, std::span<const std::int32_t> offsets, std::span<const std::int32_t> sources) {
  return filled(offsets.size() - 1, x.columns(),
                [&](std::size_t v, float* out) { mean_of_rows(x.data(), x.columns(), segment(offsets, sources, v), out); });
}

Tensor max_by(const Tensor& x, std::span<const std::int32_t> offsets, std::span<const float> scale, std::span<const float> shift) {
  return filled(offsets.size() - 1, x.columns(), [&](std::size_t s, float* out) {
    assert(offsets[s] < offsets[s + 1]);
    const auto first = static_cast<std::size_t>(offsets[s]), count = static_cast<std::size_t>(offsets[s + 1]) - first;
    max_of_rows(x.row(first).data(), count, x.columns(), scale.data(), shift.data(), out);
  });
}

Tensor attend(const Tensor& x, std::span<const std::int32_t> offsets, std::span<const std::int32_t> sources, std::size_t heads) {
  assert(offsets.size() == x.rows() + 1 && x.columns() % (16 * heads) == 0);
  return filled(x.rows(), x.columns(), [&](std::size_t v, float* out) {
    const auto own = segment(offsets, sources, v);
    float* const scores = thread_scratch(score_slot, own.size() * heads);
    head_products(x.row(v).data(), x.data(), x.columns(), own, heads, scores);
    softmax({scores, own.size() * heads}, heads);
    sum_of_heads(x.data(), x.columns(), own, heads, scores, out);
  });
}

}  // namespace osteon::tensor
