// SPDX-License-Identifier: Apache-2.0
#include "osteon/train/edge_layer.h"

#include <algorithm>
#include <functional>
#include <utility>

#include "osteon/train/gemm.h"
#include "osteon/train/row_loops.h"

namespace osteon::train {
namespace {

constexpr std::int64_t tile_edges = 512;  // 512 x 256 floats: half a megabyte, a quarter of the second-level cache

struct Graph {
  const std::int32_t *offsets, *sources;
  std::int64_t vertices, edges;

  explicit Graph(const EdgeIndices& indices)
      : offsets(indices.offsets.data_ptr<std::int32_t>()),
        sources(indices.sources.data_ptr<std::int32_t>()),
        vertices(indices.offsets.size(0) - 1),
        edges(indices.sources.size(0)) {}
  EdgeRange range(std::int64_t first, std::int64_t last) const { return {offsets, sources, first, last}; }
};

// Consecutive receivers with about tile_edges edges together.
void for_tiles(const Graph& graph, std::int64_t first, std::int64_t last, const std::function<void(const EdgeRange&)>& body) {
  while (first < last) {
    std::int64_t end = first + 1;
    while (end < last && graph.offsets[end + 1] - graph.offsets[first] <= tile_edges) ++end;
    body(graph.range(first, end));
    first = end;
  }
}

// The second layer with the first normalisation folded in: W' = W diag(scale), b' = b + W shift.
struct Folded {
  std::vector<float> weight, bias;
};

Folded fold(const at::Tensor& weight, const at::Tensor& bias, const Norm& norm) {
  const std::int64_t width = weight.size(0);
  const float* w = weight.data_ptr<float>();
  Folded folded{std::vector<float>(width * width), std::vector<float>(width)};
  for (std::int64_t i = 0; i < width; ++i) {
    double sum = bias.data_ptr<float>()[i];
    for (std::int64_t c = 0; c < width; ++c) {
      folded.weight[i * width + c] = w[i * width + c] * norm.scale[c];
      sum += static_cast<double>(w[i * width + c]) * norm.shift[c];
    }
    folded.bias[i] = static_cast<float>(sum);
  }
  return folded;
}

std::vector<float> signs(const at::Tensor& norm_weight) {
  std::vector<float> sign(norm_weight.size(0));
  std::transform(norm_weight.data_ptr<float>(), norm_weight.data_ptr<float>() + sign.size(), sign.begin(),
                 [](float w) { return w < 0.0f ? -1.0f : 1.0f; });
  return sign;
}

Norm first_norm(const EdgeTerms& terms, const Graph& graph, const NormParameters& parameters, const NormRule& rule) {
  GroupSums sum(terms.width), squares(terms.width);
  for_row_groups(graph.vertices, [&](int group, std::int64_t first, std::int64_t last) {
    edge_hidden_moments(terms, graph.range(first, last), sum.of(group), squares.of(group));
  });
  return batch_norm_of(sum, squares, graph.edges, parameters, rule);
}

// The scratch of one group of rows: one row for each edge of its largest tile.
std::vector<float> tile_buffer(const Graph& graph, std::int64_t first, std::int64_t last, std::int64_t width) {
  std::int64_t largest = 0;
  for_tiles(graph, first, last, [&](const EdgeRange& tile) { largest = std::max(largest, tile.edges()); });
  return std::vector<float>(largest * width);
}

// Products, ReLU and maximum for the receivers first .. last-1. r_of gives where a tile's rows go.
struct Second {
  const Folded& folded;
  const std::vector<float>& sign;
  float* best;
  std::int32_t* arg;
};
void second_layer(const EdgeTerms& terms, const Graph& graph, std::int64_t first, std::int64_t last, const Second& to, float* sum,
                  float* squares, const std::function<float*(const EdgeRange&)>& r_of) {
  std::vector<float> hidden = tile_buffer(graph, first, last, terms.width);
  for_tiles(graph, first, last, [&](const EdgeRange& tile) {
    const std::int64_t width = terms.width;
    float* r = r_of(tile);
    edge_hidden(terms, tile, hidden.data());
    gemm(tile.edges(), width, width, {hidden.data(), width}, {to.folded.weight.data(), width, Transposed::yes}, 0.0f, r, width);
    edge_maximum(tile, width, r, {to.folded.bias.data(), to.sign.data(), to.best, to.arg, sum, squares});
  });
}

// best holds sign * r; makes it r, and returns scale * r + shift.
at::Tensor finish(at::Tensor& best, const std::vector<float>& sign, const Norm& norm) {
  const std::int64_t vertices = best.size(0), width = best.size(1);
  at::Tensor out = at::empty_like(best);
  for_row_groups(vertices, [&](int, std::int64_t first, std::int64_t last) {
    float* b = best.data_ptr<float>() + first * width;
    float* o = out.data_ptr<float>() + first * width;
    for (std::int64_t v = first; v < last; ++v, b += width, o += width)
      for (std::int64_t c = 0; c < width; ++c) {
        b[c] *= sign[c];
        o[c] = norm.scale[c] * b[c] + norm.shift[c];
      }
  });
  return out;
}

// Sums over vertices of gradient and gradient * best: those of the second normalisation's output over edges.
std::pair<std::vector<double>, std::vector<double>> maximum_sums(const at::Tensor& gradient, const at::Tensor& best) {
  const std::int64_t width = best.size(1);
  GroupSums sum(width), product(width);
  for_row_groups(best.size(0), [&](int group, std::int64_t first, std::int64_t last) {
    relu_affine_sums(best.data_ptr<float>() + first * width, gradient.data_ptr<float>() + first * width, last - first, width, sum.of(group),
                     product.of(group));  // best >= 0 already
  });
  return {sum.total(), product.total()};
}

// r becomes the gradient of the products; returns sum over edges of gradient x hidden, (H,H), and of the gradient, (H).
struct ProductSums {
  std::vector<double> outer, plain;
};
ProductSums through_maximum(const Graph& graph, const EdgeTerms& terms, float* r, const EdgeMaximumGradient& in) {
  const std::int64_t width = terms.width;
  GroupSums outer(width * width), plain(width);
  for_row_groups(graph.vertices, [&](int group, std::int64_t first, std::int64_t last) {
    std::vector<float> hidden = tile_buffer(graph, first, last, width);
    EdgeMaximumGradient here = in;
    here.sum = plain.of(group);
    for_tiles(graph, first, last, [&](const EdgeRange& tile) {
      float* rows = r + tile.offsets[tile.first] * width;
      edge_hidden(terms, tile, hidden.data());
      edge_maximum_backward(tile, width, rows, here);
      gemm(width, width, tile.edges(), {rows, width, Transposed::yes}, {hidden.data(), width}, 1.0f, outer.of(group), width);
    });
  });
  return {outer.total(), plain.total()};
}

// Gradients of W, b and of the first normalisation, from the sums over edges alone (before any edge is visited again).
NormGradient second_layer_gradients(const EdgeLayerParameters& parameters, const EdgeLayerMemory& memory, const ProductSums& sums,
                                    std::int64_t edges, EdgeLayerGradients& gradients) {
  const auto width = static_cast<std::size_t>(parameters.weight.size(0));
  const float* w = parameters.weight.data_ptr<float>();
  gradients.weight = at::empty_like(parameters.weight);
  gradients.bias = to_tensor(sums.plain);
  std::vector<double> sum(width, 0.0), product(width, 0.0);
  for (std::size_t i = 0; i < width; ++i)
    for (std::size_t c = 0; c < width; ++c) {
      const double outer = sums.outer[i * width + c];
      sum[c] += w[i * width + c] * sums.plain[i];
      product[c] += w[i * width + c] * outer;
      gradients.weight.data_ptr<float>()[i * width + c] =
          static_cast<float>(memory.norm1.scale[c] * outer + memory.norm1.shift[c] * sums.plain[i]);
    }
  NormGradient norm = norm_gradient(memory.norm1, sum, product, edges);
  gradients.norm1_weight = norm.weight;
  gradients.norm1_bias = norm.bias;
  return norm;
}

// Which edges each vertex sends along: a counting sort, so in the order of the edges.
std::pair<std::vector<std::int32_t>, std::vector<std::int32_t>> by_source(const Graph& graph) {
  std::vector<std::int32_t> offsets(graph.vertices + 1, 0), edges(graph.edges);
  for (std::int64_t e = 0; e < graph.edges; ++e) ++offsets[graph.sources[e] + 1];
  for (std::int64_t v = 0; v < graph.vertices; ++v) offsets[v + 1] += offsets[v];
  std::vector<std::int32_t> next(offsets.begin(), offsets.end() - 1);
  for (std::int64_t e = 0; e < graph.edges; ++e) edges[next[graph.sources[e]]++] = static_cast<std::int32_t>(e);
  return {std::move(offsets), std::move(edges)};
}

// d (E,H): in: gradient of the products; used up. Returns the gradient of the terms, (V,2H).
at::Tensor through_hidden(const Graph& graph, const EdgeTerms& terms, const Folded& folded, const NormGradient& norm, float* d) {
  const std::int64_t width = terms.width;
  at::Tensor gradient = at::empty({graph.vertices, 2 * width}, at::kFloat);
  float* out = gradient.data_ptr<float>();
  for_row_groups(graph.vertices, [&](int, std::int64_t first, std::int64_t last) {
    std::vector<float> hidden = tile_buffer(graph, first, last, width), moved = hidden;
    for_tiles(graph, first, last, [&](const EdgeRange& tile) {
      float* rows = d + tile.offsets[tile.first] * width;
      edge_hidden(terms, tile, hidden.data());
      gemm(tile.edges(), width, width, {rows, width}, {folded.weight.data(), width}, 0.0f, moved.data(), width);
      edge_hidden_backward(tile, width, hidden.data(), moved.data(), {norm.constant.data(), norm.slope.data(), rows, out});
    });
  });
  const auto [offsets, edges] = by_source(graph);
  for_row_groups(graph.vertices, [&, &offsets = offsets, &edges = edges](int, std::int64_t first, std::int64_t last) {
    sum_rows({offsets.data(), edges.data(), first, last}, d, width, out + width, 2 * width);
  });
  return gradient;
}

}  // namespace

at::Tensor edge_layer_train(const at::Tensor& terms, const EdgeIndices& edges, const EdgeLayerParameters& parameters, const NormRule& rule,
                            EdgeLayerMemory& memory) {
  const Graph graph(edges);
  const EdgeTerms views{terms.data_ptr<float>(), terms.size(1) / 2};
  memory.terms = terms;
  memory.r = at::empty({graph.edges, views.width}, at::kFloat);
  memory.best = at::empty({graph.vertices, views.width}, at::kFloat);
  memory.arg = at::empty({graph.vertices, views.width}, at::kInt);
  memory.norm1 = first_norm(views, graph, parameters.norm1, rule);
  const Folded folded = fold(parameters.weight, parameters.bias, memory.norm1);
  const std::vector<float> sign = signs(parameters.norm2.weight);
  const Second to{folded, sign, memory.best.data_ptr<float>(), memory.arg.data_ptr<std::int32_t>()};
  float* r = memory.r.data_ptr<float>();
  GroupSums sum(views.width), squares(views.width);
  for_row_groups(graph.vertices, [&](int group, std::int64_t first, std::int64_t last) {
    second_layer(views, graph, first, last, to, sum.of(group), squares.of(group),
                 [&](const EdgeRange& tile) { return r + tile.offsets[tile.first] * views.width; });
  });
  memory.norm2 = batch_norm_of(sum, squares, graph.edges, parameters.norm2, rule);
  return finish(memory.best, sign, memory.norm2);
}

EdgeLayerGradients edge_layer_backward(const at::Tensor& gradient, const EdgeIndices& edges, const EdgeLayerParameters& parameters,
                                       EdgeLayerMemory& memory) {
  const Graph graph(edges);
  const EdgeTerms views{memory.terms.data_ptr<float>(), memory.terms.size(1) / 2};
  float* r = memory.r.data_ptr<float>();
  EdgeLayerGradients gradients;
  const auto [sum, product] = maximum_sums(gradient, memory.best);
  const NormGradient norm2 = norm_gradient(memory.norm2, sum, product, graph.edges);
  gradients.norm2_weight = norm2.weight;
  gradients.norm2_bias = norm2.bias;
  const ProductSums sums = through_maximum(graph, views, r,
                                           {gradient.data_ptr<float>(), memory.arg.data_ptr<std::int32_t>(), memory.norm2.scale.data(),
                                            norm2.constant.data(), norm2.slope.data(), nullptr});
  const NormGradient norm1 = second_layer_gradients(parameters, memory, sums, graph.edges, gradients);
  const Folded folded = fold(parameters.weight, parameters.bias, memory.norm1);
  gradients.terms = through_hidden(graph, views, folded, norm1, r);
  memory = {};
  return gradients;
}

at::Tensor edge_layer_use(const at::Tensor& terms, const EdgeIndices& edges, const EdgeLayerParameters& parameters) {
  const Graph graph(edges);
  const EdgeTerms views{terms.data_ptr<float>(), terms.size(1) / 2};
  const Folded folded = fold(parameters.weight, parameters.bias, stored_norm_of(parameters.norm1));
  const std::vector<float> sign = signs(parameters.norm2.weight);
  at::Tensor best = at::empty({graph.vertices, views.width}, at::kFloat), arg = at::empty({graph.vertices, views.width}, at::kInt);
  const Second to{folded, sign, best.data_ptr<float>(), arg.data_ptr<std::int32_t>()};
  GroupSums sum(views.width), squares(views.width);
  for_row_groups(graph.vertices, [&](int group, std::int64_t first, std::int64_t last) {
    std::vector<float> r = tile_buffer(graph, first, last, views.width);
    second_layer(views, graph, first, last, to, sum.of(group), squares.of(group), [&](const EdgeRange&) { return r.data(); });
  });
  return finish(best, sign, stored_norm_of(parameters.norm2));
}

}  // namespace osteon::train
