// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

// The inner loops of the CPU layers: rows of `width` floats, the columns vectorised. They run in the calling thread.
namespace osteon::train {

// Receivers first .. last-1 with their incoming edges; see nets::Edges. Edge rows of a tile are counted from offsets[first].
struct EdgeRange {
  const std::int32_t *offsets, *sources;
  std::int64_t first, last;

  std::int64_t edges() const { return offsets[last] - offsets[first]; }
};

// The two halves of the first edge layer, (V, 2 width): what a vertex gives as receiver (with the bias), then what it gives as source.
struct EdgeTerms {
  const float* values;
  std::int64_t width;
};

// h (edges, width) = relu(receiver term + source term)
void edge_hidden(const EdgeTerms& terms, const EdgeRange& range, float* h);

// The same, not written but added up: sum[c] += h, squares[c] += h * h.
void edge_hidden_moments(const EdgeTerms& terms, const EdgeRange& range, float* sum, float* squares);

// r (edges, width): in: products of the second edge layer; out: relu(r + bias). Adds up its moments; best (V,width) and arg (V,width): the
// largest value of sign * r among a receiver's edges, and at which edge of the graph (the first, when several are equal).
struct EdgeMaximum {
  const float *bias, *sign;
  float* best;
  std::int32_t* arg;
  float *sum, *squares;
};
void edge_maximum(const EdgeRange& range, std::int64_t width, float* r, const EdgeMaximum& out);

// Through maximum, normalisation and ReLU of the second edge layer. r: in: its rectified values; out: gradient of its products,
// (r > 0) * (scale * [arg == edge] * gradient - constant - slope * r). Adds it up per column in `sum`.
struct EdgeMaximumGradient {
  const float* gradient;    // (V,width)
  const std::int32_t* arg;  // (V,width)
  const float *scale, *constant, *slope;
  float* sum;
};
void edge_maximum_backward(const EdgeRange& range, std::int64_t width, float* r, const EdgeMaximumGradient& in);

// Through normalisation and ReLU of the first edge layer. d (edges, width): gradient of the normalised values times the scale; dh: gets
// (h > 0) * (d - constant - slope * h). receivers (V, 2 width): its first half gets the sums over each receiver's edges.
struct EdgeHiddenGradient {
  const float *constant, *slope;
  float* dh;
  float* receivers;
};
void edge_hidden_backward(const EdgeRange& range, std::int64_t width, const float* h, const float* d, const EdgeHiddenGradient& out);

// out[v] = sum of the rows items[offsets[v]] .. items[offsets[v+1]-1] of x, for v in first .. last-1; rows of `out` are `stride` apart.
struct RowGroups {
  const std::int32_t *offsets, *items;
  std::int64_t first, last;
};
void sum_rows(const RowGroups& groups, const float* x, std::int64_t width, float* out, std::int64_t stride);

// best (width): largest of rows first .. last-1 of x, per column, and arg: in which row (the first, when several are equal).
struct Rows {
  const float* values;
  std::int64_t width;
};
void row_maximum(const Rows& x, std::int64_t first, std::int64_t last, float* best, std::int32_t* arg);

// sum[c] += relu(x), squares[c] += relu(x)^2 over rows.
void relu_moments(const float* x, std::int64_t rows, std::int64_t width, float* sum, float* squares);

// y = scale * relu(x) + shift
void relu_affine(const float* x, std::int64_t rows, std::int64_t width, const float* scale, const float* shift, float* y);

// sum[c] += gradient, product[c] += gradient * relu(x)
void relu_affine_sums(const float* x, const float* gradient, std::int64_t rows, std::int64_t width, float* sum, float* product);

// dx = (x > 0) * (scale * gradient - constant - slope * x)
struct ReluAffineGradient {
  const float *scale, *constant, *slope;
};
void relu_affine_backward(const float* x, const float* gradient, std::int64_t rows, std::int64_t width, const ReluAffineGradient& by,
                          float* dx);

// The dot product of two rows.
float dot(const float* a, const float* b, std::int64_t width);

// y += scale * x
void add_scaled(const float* x, std::int64_t width, float scale, float* y);

// sum[c] += x over rows
void column_sums(const float* x, std::int64_t rows, std::int64_t width, float* sum);

}  // namespace osteon::train
