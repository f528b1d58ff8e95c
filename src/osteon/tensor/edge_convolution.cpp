// SPDX-License-Identifier: Apache-2.0
#include "osteon/tensor/edge_convolution.h"

#include <algorithm>
#include <cassert>
#include <limits>

#include "osteon/base/parallel.h"
#include "osteon/tensor/row_loops.h"

namespace osteon::tensor {
namespace {

constexpr int hidden_slot = 6, message_slot = 7;  // thread_scratch
constexpr std::size_t vertices_at_a_time = 64;    // with 7 or 11 messages each the last, partly filled product of a range costs little

PackedMlp pack_ends(const DenseLayer& layer) {
  const PackedMlp::Block all{static_cast<std::size_t>(layer.weights.cols()), Reading::own_row};
  return PackedMlp({&all, 1}, {&layer, 1});
}

}  // namespace

EdgeConvolution::EdgeConvolution(Weights weights)
    : ends_(pack_ends(weights.ends)),
      messages_(weights.messages, {}, Activation::none, weights.ends.precision),
      sign_(std::move(weights.sign)),
      shift_(std::move(weights.shift)) {
  assert(ends_.outputs() == 2 * messages_.outputs());
}

void EdgeConvolution::run_vertices(const Tensor& ends, const EdgeList& edges, std::size_t begin, std::size_t end, float* out) const {
  const std::size_t width = messages_.outputs();
  const auto first_edge = static_cast<std::size_t>(edges.offsets[begin]), last_edge = static_cast<std::size_t>(edges.offsets[end]);
  const std::size_t tile = 2 * messages_.tile_rows();
  float* const hidden = thread_scratch(hidden_slot, tile * width);
  float* const messages = thread_scratch(message_slot, tile * width);

  std::fill_n(out, (end - begin) * width, -std::numeric_limits<float>::infinity());
  for (std::size_t e = first_edge; e < last_edge; e += tile) {
    const std::size_t count = std::min(tile, last_edge - e);
    const auto receivers = edges.receivers.subspan(e, count);
    gather_add_relu(ends.data(), ends.data() + width, ends.columns(), receivers, edges.sources.subspan(e, count), width, hidden);
    messages_(hidden, count, messages);
    max_into(messages, receivers, static_cast<std::int32_t>(begin), width, out);
  }
  sign_shift_relu(out, end - begin, width, sign_.data(), shift_.data());
}

Tensor EdgeConvolution::operator()(const Tensor& x, const EdgeList& edges) const {
  assert(edges.offsets.size() == x.rows() + 1);
  const InputColumns input{x, {}};
  const Tensor ends = ends_({&input, 1}, x.rows());
  Tensor out(x.rows(), messages_.outputs());
  parallel_for(x.rows(), vertices_at_a_time,
               [&](std::size_t begin, std::size_t end) { run_vertices(ends, edges, begin, end, out.row(begin).data()); });
  return out;
}

}  // namespace osteon::tensor
