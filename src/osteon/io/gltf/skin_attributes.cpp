// SPDX-License-Identifier: Apache-2.0
#include "osteon/io/gltf/skin_attributes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace osteon::io::gltf {
namespace {

// The largest weights of a row, made to sum to 1 again.
std::vector<float> leading_weights(std::span<const Influence> row, std::size_t most) {
  std::vector<float> weights;
  for (const Influence& influence : row.first(std::min(row.size(), most))) weights.push_back(influence.weight);
  const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (float& w : weights) w = static_cast<float>(static_cast<double>(w) / sum);
  return weights;
}

std::size_t add_weights(Writer& writer, const std::vector<float>& weights, WeightFormat format) {
  if (format == WeightFormat::f32) return writer.vectors(weights, 4, Target::vertices);
  std::vector<std::uint32_t> integers(weights.size());
  std::transform(weights.begin(), weights.end(), integers.begin(), [](float w) { return static_cast<std::uint32_t>(w); });
  return writer.vec4(integers, format == WeightFormat::u8 ? 1 : 2, true);
}

}  // namespace

std::vector<std::uint32_t> quantized(std::span<const float> weights, std::uint32_t total) {
  std::vector<std::uint32_t> out;
  std::vector<std::size_t> order(weights.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<double> remainders;
  std::uint32_t left = total;
  for (const float w : weights) {
    const double exact = static_cast<double>(w) * total;
    out.push_back(std::min(static_cast<std::uint32_t>(exact), left));
    left -= out.back();
    remainders.push_back(exact - out.back());
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return remainders[a] > remainders[b]; });
  for (std::size_t k = 0; left > 0; ++k, --left) ++out[order[k % order.size()]];
  return out;
}

Json add_skin_attributes(Writer& writer, std::span<const VertexId> vertices, const SkinWeights& weights, std::size_t joints,
                         const SaveOptions& options) {
  assert(options.max_influences >= 1 && options.max_influences <= 8);
  const auto most = static_cast<std::size_t>(options.max_influences);
  const std::size_t sets = (most + 3) / 4;
  std::vector<std::vector<std::uint32_t>> joint_sets(sets, std::vector<std::uint32_t>(4 * vertices.size()));
  std::vector<std::vector<float>> weight_sets(sets, std::vector<float>(4 * vertices.size()));
  for (std::size_t v = 0; v < vertices.size(); ++v) {
    const auto row = weights[vertices[v]];
    std::vector<float> values = leading_weights(row, most);
    if (options.weights != WeightFormat::f32) {
      const auto integers = quantized(values, options.weights == WeightFormat::u8 ? 255 : 65535);
      values.assign(integers.begin(), integers.end());
    }
    for (std::size_t k = 0; k < values.size(); ++k) {
      if (values[k] == 0.0f) continue;  // too small for its integer
      joint_sets[k / 4][4 * v + k % 4] = static_cast<std::uint32_t>(index(row[k].joint));
      weight_sets[k / 4][4 * v + k % 4] = values[k];
    }
  }
  Json attributes = Json::object();
  for (std::size_t set = 0; set < sets; ++set) {
    attributes[fmt::format("JOINTS_{}", set)] = writer.vec4(joint_sets[set], joints <= 255 ? 1 : 2, false);
    attributes[fmt::format("WEIGHTS_{}", set)] = add_weights(writer, weight_sets[set], options.weights);
  }
  return attributes;
}

}  // namespace osteon::io::gltf
