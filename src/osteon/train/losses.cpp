// SPDX-License-Identifier: Apache-2.0
#include "osteon/train/losses.h"

#include <ATen/core/grad_mode.h>
#include <torch/types.h>

#include <algorithm>

namespace osteon::train {
namespace {

// Distances of rows of a and b; the square root's slope stays finite where they coincide.
at::Tensor distances(const at::Tensor& a, const at::Tensor& b) { return ((a - b).square().sum(1) + 1e-12).sqrt(); }

at::Tensor pair_cross_entropy(const at::Tensor& logits, const at::Tensor& targets) {
  return at::binary_cross_entropy_with_logits(logits.squeeze(1), targets, {}, {}, at::Reduction::None);
}

}  // namespace

at::Tensor attention_loss(const at::Tensor& logits, const at::Tensor& targets) { return pair_cross_entropy(logits, targets).mean(); }

at::Tensor chamfer(const at::Tensor& points, const at::Tensor& joints) {
  at::Tensor nearest_joint, nearest_point;
  {
    const at::NoGradGuard no_grad;
    const at::Tensor squared = (points.unsqueeze(1) - joints.unsqueeze(0)).square().sum(2);
    nearest_joint = squared.argmin(1);
    nearest_point = squared.argmin(0);
  }
  return 0.5 * (distances(points, joints.index_select(0, nearest_joint)).mean() +
                distances(points.index_select(0, nearest_point), joints).mean());
}

at::Tensor density_loss(const at::Tensor& points, const at::Tensor& logits, const at::Tensor& joints, double width) {
  const at::Tensor squared = (joints.unsqueeze(1) - points.unsqueeze(0)).square().sum(2);  // (J,V)
  const at::Tensor log_kernel = -3.0 * at::log1p(squared / (width * width));
  const at::Tensor log_attention = at::log_sigmoid(logits.squeeze(1));
  return at::logsumexp(log_attention, 0) - at::logsumexp(log_kernel + log_attention.unsqueeze(0), 1).mean();
}

at::Tensor trail_loss(const std::vector<at::Tensor>& trail, const at::Tensor& joints) {
  at::Tensor sum = at::zeros({}, joints.options());
  for (const at::Tensor& points : trail) sum = sum + chamfer(points, joints);
  return sum / static_cast<double>(trail.size());
}

at::Tensor bone_loss(const at::Tensor& logits, const at::Tensor& targets) {
  const at::Tensor each = pair_cross_entropy(logits, targets);
  const std::int64_t hardest = std::max<std::int64_t>(1, each.size(0) * 3 / 10);
  return each.mean() + std::get<0>(each.topk(hardest)).mean();
}

at::Tensor root_loss(const at::Tensor& logits, const std::vector<std::int32_t>& offsets, const std::vector<std::int32_t>& roots) {
  at::Tensor sum = at::zeros({}, logits.options());
  for (std::size_t m = 0; m < roots.size(); ++m) {
    const at::Tensor of_mesh = logits.squeeze(1).narrow(0, offsets[m], offsets[m + 1] - offsets[m]);
    sum = sum - at::log_softmax(of_mesh, 0)[roots[m] - offsets[m]];
  }
  return sum / static_cast<double>(roots.size());
}

at::Tensor tree_loss(const at::Tensor& logits, const std::vector<std::int32_t>& offsets, const std::vector<std::int64_t>& parents) {
  at::Tensor sum = at::zeros({}, logits.options());
  std::int64_t first_pair = 0;
  for (std::size_t m = 0; m + 1 < offsets.size(); ++m) {
    const std::int64_t first = offsets[m], joints = offsets[m + 1] - first;
    const at::Tensor of_joint = logits.narrow(0, first_pair, joints * joints).view({joints, joints}).log_softmax(1);
    const std::vector<std::int64_t> own(parents.begin() + first, parents.begin() + first + joints);
    const at::Tensor wanted = at::tensor(own, at::kLong).to(logits.device());
    const auto root =
        std::ranges::find_if(own, [&, j = std::int64_t{0}](std::int64_t parent) mutable { return parent == j++; }) - own.begin();
    sum = sum - of_joint.gather(1, wanted.unsqueeze(1)).mean() - of_joint.diagonal().log_softmax(0)[root];
    first_pair += joints * joints;
  }
  return sum / static_cast<double>(offsets.size() - 1);
}

at::Tensor skin_loss(const at::Tensor& logits, const at::Tensor& weights, const at::Tensor& share) {
  const at::Tensor each = -(weights * at::log_softmax(logits, 1)).sum(1);
  return (each * share).sum() / (share.sum() + 1e-8);
}

at::Tensor skin_difference(const at::Tensor& logits, const at::Tensor& weights, const at::Tensor& share) {
  return ((logits.softmax(1) - weights * share.unsqueeze(1)).abs().sum(1) + (1.0 - share)).mean();
}

}  // namespace osteon::train
