// SPDX-License-Identifier: Apache-2.0
#include <ATen/Parallel.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "osteon/train/fused_ops.h"
#include "osteon/train/row_loops.h"

namespace osteon::train {
namespace {

using torch::Tensor;
using torch::autograd::AutogradContext;
using torch::autograd::variable_list;

constexpr std::int64_t grain = 64;  // vertices of a task
constexpr std::int64_t block = 64;  // columns of a task, where rows are added to

struct Segments {
  const std::int32_t *offsets, *sources;
  std::int64_t count;

  Segments(const Tensor& o, const Tensor& s)
      : offsets(o.data_ptr<std::int32_t>()), sources(s.data_ptr<std::int32_t>()), count(o.size(0) - 1) {}
};

struct SegmentMean : torch::autograd::Function<SegmentMean> {
  static Tensor forward(AutogradContext* context, const Tensor& given, const Tensor& offsets, const Tensor& sources) {
    const Tensor x = given.contiguous();
    const Segments segments(offsets, sources);
    const std::int64_t width = x.size(1);
    Tensor y = torch::zeros({segments.count, width});
    at::parallel_for(0, segments.count, grain, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t v = begin; v < end; ++v) {
        float* to = y.data_ptr<float>() + v * width;
        const float share = 1.0f / static_cast<float>(segments.offsets[v + 1] - segments.offsets[v]);
        for (std::int32_t e = segments.offsets[v]; e < segments.offsets[v + 1]; ++e)
          add_scaled(x.data_ptr<float>() + segments.sources[e] * width, width, share, to);
      }
    });
    context->save_for_backward({offsets, sources});
    context->saved_data["rows"] = x.size(0);
    return y;
  }

  // Every task has columns of its own, so that no sum depends on the order of the tasks.
  static variable_list backward(AutogradContext* context, variable_list gradients) {
    const variable_list saved = context->get_saved_variables();
    const Tensor dy = gradients[0].contiguous();
    const Segments segments(saved[0], saved[1]);
    const std::int64_t width = dy.size(1);
    Tensor dx = torch::zeros({context->saved_data["rows"].toInt(), width});
    at::parallel_for(0, (width + block - 1) / block, 1, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t b = begin; b < end; ++b) {
        const std::int64_t first = b * block, columns = std::min(block, width - first);
        for (std::int64_t v = 0; v < segments.count; ++v) {
          const float share = 1.0f / static_cast<float>(segments.offsets[v + 1] - segments.offsets[v]);
          for (std::int32_t e = segments.offsets[v]; e < segments.offsets[v + 1]; ++e)
            add_scaled(dy.data_ptr<float>() + v * width + first, columns, share,
                       dx.data_ptr<float>() + segments.sources[e] * width + first);
        }
      }
    });
    return {dx, Tensor(), Tensor()};
  }
};

// Shares (E,heads): the softmax of every edge's scores.
struct GraphAttention : torch::autograd::Function<GraphAttention> {
  static Tensor forward(AutogradContext* context, const Tensor& given, const Tensor& offsets, const Tensor& sources, std::int64_t heads) {
    const Tensor x = given.contiguous();
    const Segments segments(offsets, sources);
    const std::int64_t columns = x.size(1), width = columns / heads;
    Tensor y = torch::zeros_like(x), shares = torch::empty({sources.size(0), heads});
    at::parallel_for(0, segments.count, grain, [&](std::int64_t begin, std::int64_t end) {
      for (std::int64_t v = begin; v < end; ++v)
        for (std::int64_t h = 0; h < heads; ++h) {
          const float* all = x.data_ptr<float>() + h * width;
          float* share = shares.data_ptr<float>() + h;
          const std::int32_t first = segments.offsets[v], last = segments.offsets[v + 1];
          float largest = -INFINITY, total = 0.0f;
          for (std::int32_t e = first; e < last; ++e)
            largest = std::max(largest, share[e * heads] = dot(all + v * columns, all + segments.sources[e] * columns, width));
          for (std::int32_t e = first; e < last; ++e) total += share[e * heads] = std::exp(share[e * heads] - largest);
          for (std::int32_t e = first; e < last; ++e) {
            share[e * heads] /= total;
            add_scaled(all + segments.sources[e] * columns, width, share[e * heads], y.data_ptr<float>() + v * columns + h * width);
          }
        }
    });
    context->save_for_backward({x, offsets, sources, shares});
    return y;
  }

  // With a the shares and s the scores: da_e = dy_v . x_u, ds_e = a_e (da_e - sum a da), dx_u += a_e dy_v + ds_e x_v, dx_v += ds_e x_u.
  // Every head is a task: it has columns of its own.
  static variable_list backward(AutogradContext* context, variable_list gradients) {
    const variable_list saved = context->get_saved_variables();
    const Tensor dy = gradients[0].contiguous(), &x = saved[0], &shares = saved[3];
    const Segments segments(saved[1], saved[2]);
    const std::int64_t columns = x.size(1), heads = shares.size(1), width = columns / heads;
    Tensor dx = torch::zeros_like(x);
    at::parallel_for(0, heads, 1, [&](std::int64_t begin, std::int64_t end) {
      std::vector<float> slopes;
      for (std::int64_t h = begin; h < end; ++h) {
        const float *all = x.data_ptr<float>() + h * width, *share = shares.data_ptr<float>() + h;
        float* to = dx.data_ptr<float>() + h * width;
        for (std::int64_t v = 0; v < segments.count; ++v) {
          const std::int32_t first = segments.offsets[v], last = segments.offsets[v + 1];
          const float* d = dy.data_ptr<float>() + v * columns + h * width;
          slopes.assign(static_cast<std::size_t>(last - first), 0.0f);
          float mean = 0.0f;
          for (std::int32_t e = first; e < last; ++e) {
            slopes[static_cast<std::size_t>(e - first)] = dot(d, all + segments.sources[e] * columns, width);
            mean += share[e * heads] * slopes[static_cast<std::size_t>(e - first)];
          }
          for (std::int32_t e = first; e < last; ++e) {
            const float slope = share[e * heads] * (slopes[static_cast<std::size_t>(e - first)] - mean);
            const std::int64_t u = segments.sources[e] * columns;
            add_scaled(d, width, share[e * heads], to + u);
            add_scaled(all + v * columns, width, slope, to + u);
            add_scaled(all + u, width, slope, to + v * columns);
          }
        }
      }
    });
    return {dx, Tensor(), Tensor(), Tensor()};
  }
};

}  // namespace

Tensor segment_mean(const Tensor& x, const Tensor& offsets, const Tensor& sources) { return SegmentMean::apply(x, offsets, sources); }

Tensor graph_attention(const Tensor& x, const Tensor& offsets, const Tensor& sources, std::int64_t heads) {
  return GraphAttention::apply(x, offsets, sources, heads);
}

}  // namespace osteon::train
