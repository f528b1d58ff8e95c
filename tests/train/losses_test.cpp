// SPDX-License-Identifier: Apache-2.0
#include "osteon/train/losses.h"

#include <gtest/gtest.h>
#include <torch/types.h>

#include <cmath>
#include <functional>

#include "osteon/base/random.h"
#include "osteon/train/mean_shift.h"

namespace osteon::train {
namespace {

at::Tensor random_points(std::int64_t count, std::int64_t columns, std::uint64_t seed, float size) {
  Random random(seed);
  at::Tensor x = at::empty({count, columns});
  for (std::int64_t i = 0; i < x.numel(); ++i) x.data_ptr<float>()[i] = random.uniform(0.0f, size);
  return x;
}

// Largest difference between the gradient of f and central differences, both in double precision.
double gradient_error(const std::function<at::Tensor(const at::Tensor&)>& f, const at::Tensor& at_point) {
  at::Tensor x = at_point.to(at::kDouble).clone().set_requires_grad(true);
  f(x).backward();
  double worst = 0.0;
  const at::NoGradGuard no_grad;
  for (std::int64_t i = 0; i < x.numel(); ++i) {
    constexpr double h = 1e-6;
    const auto shifted = [&](double by) {
      at::Tensor y = x.detach().clone();
      y.view({-1})[i] += by;
      return f(y).item<double>();
    };
    worst = std::max(worst, std::abs((shifted(h) - shifted(-h)) / (2.0 * h) - x.grad().view({-1})[i].item<double>()));
  }
  return worst;
}

TEST(Chamfer, of_two_points_is_their_distance) {
  EXPECT_NEAR(chamfer(torch::tensor({{0.0f, 0.0f, 0.0f}}), torch::tensor({{0.3f, 0.0f, 0.4f}})).item<float>(), 0.5f, 1e-6f);
}

TEST(Chamfer, counts_both_ways_by_half) {
  const at::Tensor points = torch::tensor({{0.0f, 0.0f, 0.0f}, {1.0f, 0.0f, 0.0f}}), joint = torch::tensor({{0.0f, 0.0f, 0.0f}});
  EXPECT_NEAR(chamfer(points, joint).item<float>(), 0.25f, 1e-6f);
}

// Two joints of which each has half of the votes: a joint's density is half of 1 plus the kernel of the other's votes.
TEST(DensityLoss, counts_the_share_of_the_attention_that_is_at_each_joint) {
  const at::Tensor joints = torch::tensor({{0.0f, 0.0f, 0.0f}, {0.06f, 0.0f, 0.0f}}), equal = torch::tensor({{2.0f}, {2.0f}});
  const double kernel = 1.0 / std::pow(1.0 + 4.0, 3.0);
  EXPECT_NEAR(density_loss(joints, equal, joints, 0.03).item<double>(), -std::log(0.5 * (1.0 + kernel)), 1e-5);
  const at::Tensor all_on_first = torch::tensor({{9.0f}, {-30.0f}});
  EXPECT_NEAR(density_loss(joints, all_on_first, joints, 0.03).item<double>(), -0.5 * std::log(kernel), 1e-4);
}

TEST(Losses, have_the_gradients_of_central_differences) {
  const at::Tensor joints = random_points(5, 3, 1, 1.0f).to(at::kDouble), points = random_points(12, 3, 2, 1.0f);
  EXPECT_LT(gradient_error([&](const at::Tensor& x) { return chamfer(x, joints); }, points), 1e-7);
  const at::Tensor logits = random_points(20, 1, 3, 4.0f) - 2.0f, labels = (random_points(20, 1, 4, 1.0f).squeeze(1) > 0.6).to(at::kDouble);
  EXPECT_LT(gradient_error([&](const at::Tensor& x) { return attention_loss(x, labels); }, logits), 1e-7);
  const at::Tensor attention = random_points(12, 1, 8, 4.0f) - 2.0f;
  EXPECT_LT(gradient_error([&](const at::Tensor& x) { return density_loss(x, attention.to(at::kDouble), joints, 0.2); }, points), 1e-6);
  EXPECT_LT(gradient_error([&](const at::Tensor& x) { return density_loss(points.to(at::kDouble), x, joints, 0.2); }, attention), 1e-6);
  EXPECT_LT(gradient_error([&](const at::Tensor& x) { return bone_loss(x, labels); }, logits), 1e-7);
  EXPECT_LT(gradient_error([&](const at::Tensor& x) { return root_loss(x, {0, 8, 20}, {3, 8}); }, logits), 1e-7);
  EXPECT_LT(gradient_error([&](const at::Tensor& x) { return tree_loss(x, {0, 4, 6}, {1, 1, 0, 1, 0, 0}); }, logits), 1e-7);
  const at::Tensor weights = random_points(6, 5, 5, 1.0f).to(at::kDouble).softmax(1),
                   share = random_points(6, 1, 6, 1.0f).squeeze(1).to(at::kDouble);
  EXPECT_LT(gradient_error([&](const at::Tensor& x) { return skin_loss(x, weights, share); }, random_points(6, 5, 7, 2.0f)), 1e-7);
}

// Nothing but the hardest counts twice: of ten easy pairs and none hard, the loss is that of the mean plus that of the worst three.
TEST(BoneLoss, adds_the_mean_of_the_hardest_three_tenths) {
  const at::Tensor logits = torch::tensor({2.0f, 1.0f, 0.5f, 3.0f, 3.0f, 3.0f, 3.0f, 3.0f, 3.0f, 3.0f}).unsqueeze(1), ones = at::ones({10});
  const at::Tensor each = at::softplus(-logits.squeeze(1));
  EXPECT_NEAR(bone_loss(logits, ones).item<float>(), (each.mean() + each.narrow(0, 0, 3).mean()).item<float>(), 1e-6f);
}

// Two joints that both may have either as their parent: each knows nothing, and neither does the root.
TEST(TreeLoss, of_equal_logits_is_the_logarithm_of_the_choices) {
  EXPECT_NEAR(tree_loss(at::zeros({4, 1}), {0, 2}, {0, 0}).item<float>(), 2.0f * std::log(2.0f), 1e-6f);
  EXPECT_NEAR(tree_loss(at::zeros({13, 1}), {0, 2, 5}, {0, 0, 2, 2, 2}).item<float>(), std::log(2.0f) + std::log(3.0f), 1e-6f);
}

TEST(TreeLoss, vanishes_where_every_parent_is_sure) {
  const at::Tensor sure = torch::tensor({{50.0f, 0.0f, 0.0f}, {50.0f, 0.0f, 0.0f}, {0.0f, 50.0f, 0.0f}}).view({9, 1});
  EXPECT_NEAR(tree_loss(sure, {0, 3}, {0, 0, 1}).item<float>(), 0.0f, 1e-6f);
}

TEST(SkinLoss, is_the_entropy_of_the_weights_where_they_are_met) {
  const at::Tensor weights = torch::tensor({{0.5f, 0.5f, 0.0f, 0.0f, 0.0f}});
  EXPECT_NEAR(skin_loss((weights + 1e-12f).log(), weights, at::ones({1})).item<float>(), std::log(2.0f), 1e-5f);
}

// A weighted sum of where the points go, so that every one of them matters.
at::Tensor shifted_sum(const at::Tensor& points, const at::Tensor& attention, const at::Tensor& bandwidth,
                       at::Tensor (*step)(const at::Tensor&, const at::Tensor&, const at::Tensor&, double)) {
  const at::Tensor once = step(points, attention, bandwidth, 0.3);
  return (step(once, attention, bandwidth, 0.3) * at::arange(points.numel(), points.options()).view(points.sizes()).cos()).sum();
}

TEST(MeanShift, has_the_gradients_of_central_differences) {
  const at::Tensor points = random_points(15, 3, 1, 0.2f), attention = random_points(15, 1, 2, 1.0f), bandwidth = at::full({1}, 0.09);
  const at::Tensor p = points.to(at::kDouble), a = attention.to(at::kDouble), h = bandwidth.to(at::kDouble);
  EXPECT_LT(gradient_error([&](const at::Tensor& x) { return shifted_sum(x, a, h, plain_mean_shift_step); }, points), 1e-6);
  EXPECT_LT(gradient_error([&](const at::Tensor& x) { return shifted_sum(p, x, h, plain_mean_shift_step); }, attention), 1e-6);
  EXPECT_LT(gradient_error([&](const at::Tensor& x) { return shifted_sum(p, a, x, plain_mean_shift_step); }, bandwidth), 1e-6);
}

TEST(MeanShift, by_hand_is_that_of_plain_operations) {
  std::vector<at::Tensor> values, gradients;
  for (const auto step : {plain_mean_shift_step, mean_shift_step}) {
    at::Tensor points = random_points(60, 3, 1, 0.3f).set_requires_grad(true),
               attention = random_points(60, 1, 2, 1.0f).set_requires_grad(true);
    at::Tensor bandwidth = at::full({1}, 0.09).set_requires_grad(true);
    const at::Tensor value = shifted_sum(points, attention, bandwidth, step);
    value.backward();
    values.push_back(value.detach());
    gradients.push_back(at::cat({points.grad().reshape(-1), attention.grad().reshape(-1), bandwidth.grad()}));
  }
  EXPECT_NEAR(values[0].item<float>(), values[1].item<float>(), 1e-5f);
  EXPECT_LT(((gradients[0] - gradients[1]).norm() / gradients[0].norm()).item<float>(), 1e-4f);
}

TEST(MeanShift, gathers_points_within_the_bandwidth_and_leaves_others_alone) {
  const at::Tensor points = torch::tensor({{0.0f, 0.0f, 0.0f}, {0.02f, 0.0f, 0.0f}, {0.5f, 0.0f, 0.0f}});
  const at::Tensor end = mean_shift(points, at::ones({3, 1}), at::full({1}, 0.05), 40).back();
  EXPECT_NEAR((end[0] - end[1]).norm().item<float>(), 0.0f, 1e-4f);
  EXPECT_NEAR((end[2] - points[2]).norm().item<float>(), 0.0f, 1e-6f);
}

}  // namespace
}  // namespace osteon::train
