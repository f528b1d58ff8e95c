// SPDX-License-Identifier: Apache-2.0
#include "osteon/tensor/loops.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <vector>

namespace osteon::tensor::loops {
namespace {

// out(r, c) = value(r, c)
template <class Value>
Tensor filled(std::size_t rows, std::size_t columns, Value&& value) {
  Tensor out(rows, columns);
  for (std::size_t r = 0; r < rows; ++r)
    for (std::size_t c = 0; c < columns; ++c) out.row(r)[c] = value(r, c);
  return out;
}

}  // namespace

Tensor linear(const Tensor& x, const Matrix& weights, std::span<const float> bias) {
  assert(static_cast<std::size_t>(weights.cols()) == x.columns() && static_cast<std::size_t>(weights.rows()) == bias.size());
  return filled(x.rows(), bias.size(), [&](std::size_t r, std::size_t c) {
    const float* const in = x.row(r).data();
    const float* const weight = weights.row(static_cast<Eigen::Index>(c)).data();
    double sum = bias[c];  // double, so that the reference's own rounding does not count
    for (std::size_t i = 0; i < x.columns(); ++i) sum += static_cast<double>(in[i]) * weight[i];
    return static_cast<float>(sum);
  });
}

Tensor scale_shift(const Tensor& x, std::span<const float> scale, std::span<const float> shift) {
  assert(scale.size() == x.columns() && shift.size() == x.columns());
  return filled(x.rows(), x.columns(), [&](std::size_t r, std::size_t c) { return scale[c] * x.row(r)[c] + shift[c]; });
}

Tensor relu(const Tensor& x) {
  return filled(x.rows(), x.columns(), [&](std::size_t r, std::size_t c) { return std::max(0.0f, x.row(r)[c]); });
}

Tensor subtract(const Tensor& x, const Tensor& y) {
  assert(x.rows() == y.rows() && x.columns() == y.columns());
  return filled(x.rows(), x.columns(), [&](std::size_t r, std::size_t c) { return x.row(r)[c] - y.row(r)[c]; });
}

Tensor concat(std::span<const Tensor> parts) {
  std::size_t columns = 0;
  for (const Tensor& part : parts) columns += part.columns();
  Tensor out(parts.front().rows(), columns);
  std::size_t first = 0;
  for (const Tensor& part : parts) {
    assert(part.rows() == out.rows());
    for (std::size_t r = 0; r < out.rows(); ++r) std::ranges::copy(part.row(r), out.row(r).begin() + static_cast<std::ptrdiff_t>(first));
    first += part.columns();
  }
  return out;
}

Tensor rows(const Tensor& x, std::span<const std::int32_t> picked) {
  return filled(picked.size(), x.columns(), [&](std::size_t r, std::size_t c) { return x.row(static_cast<std::size_t>(picked[r]))[c]; });
}

Tensor max_by(const Tensor& x, std::span<const std::int32_t> offsets) {
  return filled(offsets.size() - 1, x.columns(), [&](std::size_t s, std::size_t c) {
    assert(offsets[s] < offsets[s + 1]);
    float best = x.row(static_cast<std::size_t>(offsets[s]))[c];
    for (std::int32_t r = offsets[s] + 1; r < offsets[s + 1]; ++r) best = std::max(best, x.row(static_cast<std::size_t>(r))[c]);
    return best;
  });
}

Tensor mean_of(const Tensor& x, std::span<const std::int32_t> offsets, std::span<const std::int32_t> sources) {
  return filled(offsets.size() - 1, x.columns(), [&](std::size_t v, std::size_t c) {
    double sum = 0;
    for (std::int32_t e = offsets[v]; e < offsets[v + 1]; ++e)
      sum += static_cast<double>(x.row(static_cast<std::size_t>(sources[static_cast<std::size_t>(e)]))[c]);
    return static_cast<float>(sum / (offsets[v + 1] - offsets[v]));
  });
}

Tensor attend(const Tensor& x, std::span<const std::int32_t> offsets, std::span<const std::int32_t> sources, std::size_t heads) {
  assert(offsets.size() == x.rows() + 1 && x.columns() % heads == 0);
  Tensor out(x.rows(), x.columns());
  const std::size_t width = x.columns() / heads;
  for (std::size_t v = 0; v < x.rows(); ++v) {
    const auto first = static_cast<std::size_t>(offsets[v]), last = static_cast<std::size_t>(offsets[v + 1]);
    const auto source = [&](std::size_t e) { return x.row(static_cast<std::size_t>(sources[e])); };
    for (std::size_t begin = 0; begin < x.columns(); begin += width) {
      std::vector<double> scores(last - first, 0.0);
      for (std::size_t e = first; e < last; ++e)
        for (std::size_t c = begin; c < begin + width; ++c)
          scores[e - first] += static_cast<double>(x.row(v)[c]) * static_cast<double>(source(e)[c]);
      const double largest = *std::ranges::max_element(scores);
      double total = 0.0;
      for (double& score : scores) total += score = std::exp(score - largest);
      for (std::size_t c = begin; c < begin + width; ++c) {
        double sum = 0.0;
        for (std::size_t e = first; e < last; ++e) sum += scores[e - first] * static_cast<double>(source(e)[c]);
        out.row(v)[c] = static_cast<float>(sum / total);
      }
    }
  }
  return out;
}

}  // namespace osteon::tensor::loops
