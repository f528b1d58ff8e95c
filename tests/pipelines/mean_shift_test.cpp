// SPDX-License-Identifier: Apache-2.0
#include "osteon/pipelines/mean_shift.h"

#include <algorithm>

#include "osteon/base/parallel.h"
#include "osteon/base/random.h"
#include "support/expect.h"

namespace osteon::pipelines {
namespace {

struct Cloud {
  std::vector<Vec3f> points;
  std::vector<float> weights;
};

// Gaussian noise around centres, weights in 0.2..1.
Cloud noisy(std::span<const Vec3f> centres, int each, float sigma, std::uint64_t seed) {
  Random random(seed);
  Cloud cloud;
  for (const Vec3f& c : centres)
    for (int k = 0; k < each; ++k) {
      cloud.points.push_back(c + sigma * Vec3f(random.normal(), random.normal(), random.normal()));
      cloud.weights.push_back(random.uniform(0.2f, 1.0f));
    }
  return cloud;
}

Cloud uniform_box(int n, std::uint64_t seed) {
  Random random(seed);
  Cloud cloud;
  for (int k = 0; k < n; ++k) {
    cloud.points.emplace_back(random.uniform(-0.5f, 0.5f), random.uniform(0.0f, 1.0f), random.uniform(-0.2f, 0.2f));
    cloud.weights.push_back(random.uniform());
  }
  return cloud;
}

// The definition, in double, over all pairs.
std::vector<Vec3f> dense_iterations(const Cloud& cloud, double h, double step, int iterations) {
  std::vector<Eigen::Vector3d> x;
  for (const Vec3f& p : cloud.points) x.push_back(p.cast<double>());
  for (int round = 0; round < iterations; ++round) {
    std::vector<Eigen::Vector3d> next = x;
    for (std::size_t j = 0; j < x.size(); ++j) {
      double sum = 0.0;
      Eigen::Vector3d moment = Eigen::Vector3d::Zero();
      for (std::size_t i = 0; i < x.size(); ++i) {
        const double k = static_cast<double>(cloud.weights[i]) * std::max(0.0, h * h - (x[i] - x[j]).squaredNorm());
        sum += k;
        moment += k * x[i];
      }
      if (sum > 0.0) next[j] += step * (moment / sum - x[j]);
    }
    x = std::move(next);
  }
  std::vector<Vec3f> out;
  for (const auto& p : x) out.push_back(p.cast<float>());
  return out;
}

TEST(MeanShift, grid_and_all_pairs_agree) {
  for (float h : {0.02f, 0.0429f, 0.1f}) {
    const Cloud cloud = uniform_box(700, 3);
    const auto grid = mean_shift(cloud.points, cloud.weights, Mirror::off, {.bandwidth = h, .most_iterations = 6});
    const auto dense = dense_iterations(cloud, static_cast<double>(h), static_cast<double>(0.3f), 6);
    for (std::size_t i = 0; i < dense.size(); ++i) EXPECT_VEC3_NEAR(grid.points[i], dense[i], 2e-5f);
  }
}

TEST(MeanShift, images_act_as_if_they_were_points) {
  const Cloud half = uniform_box(400, 4);
  Cloud whole = half;
  for (std::size_t i = 0; i < half.points.size(); ++i) {
    const Vec3f& p = half.points[i];
    whole.points.emplace_back(-p.x(), p.y(), p.z());
    whole.weights.push_back(half.weights[i]);
  }
  const MeanShiftOptions options{.bandwidth = 0.06f, .most_iterations = 5};
  const auto a = mean_shift(half.points, half.weights, Mirror::across_x, options);
  const auto b = mean_shift(whole.points, whole.weights, Mirror::off, options);
  for (std::size_t i = 0; i < half.points.size(); ++i) EXPECT_VEC3_NEAR(a.points[i], b.points[i], 1e-5f);
}

TEST(MeanShift, noise_around_separated_centres_collapses_to_them) {
  const std::vector<Vec3f> centres{{0, 0, 0}, {0.2f, 0, 0}, {0, 0.2f, 0.1f}};
  const Cloud cloud = noisy(centres, 150, 0.01f, 5);
  const auto result = mean_shift(cloud.points, cloud.weights, Mirror::off, {});
  EXPECT_TRUE(result.converged);
  for (std::size_t i = 0; i < cloud.points.size(); ++i)
    EXPECT_VEC3_NEAR(result.points[i], centres[i / 150], 0.006f);  // 3 standard errors + residue
}

TEST(MeanShift, heavier_points_pull_more) {
  const std::vector<Vec3f> points{{0, 0, 0}, {0.02f, 0, 0}};
  const std::vector<float> weights{3.0f, 1.0f};
  const auto result = mean_shift(points, weights, Mirror::off, {.bandwidth = 1.0f, .tolerance = 1e-7f});
  // The kernel is flat where the bandwidth is large, so the weighted mean (0.005) is kept nearly: not exactly, as blurring keeps it only
  // for equal kernel sums.
  for (const Vec3f& p : result.points) EXPECT_VEC3_NEAR(p, Vec3f(0.005f, 0, 0), 1e-5f);
}

TEST(MeanShift, a_point_without_neighbours_stays) {
  const std::vector<Vec3f> points{{0, 0, 0}, {5, 5, 5}};
  const std::vector<float> weights{1.0f, 0.0f};
  const auto result = mean_shift(points, weights, Mirror::off, {});
  EXPECT_EQ(result.points, points);
  EXPECT_EQ(result.iterations, 1);
}

TEST(MeanShift, any_number_of_threads_gives_the_same_bits) {
  const Cloud cloud = uniform_box(900, 6);
  const int before = threads();
  std::vector<std::vector<Vec3f>> results;
  for (int n : {1, 2, 3}) {
    set_threads(n);
    results.push_back(mean_shift(cloud.points, cloud.weights, Mirror::across_x, {}).points);
  }
  set_threads(before);
  EXPECT_EQ(results[0], results[1]);
  EXPECT_EQ(results[0], results[2]);
}

TEST(KernelDensity, counts_the_weight_at_one_place_and_its_image) {
  const std::vector<Vec3f> points{{0.3f, 0, 0}, {0.3f, 0, 0}, {0.3f, 0.05f, 0}, {0, 1, 0}};
  const std::vector<float> weights{1.0f, 2.0f, 4.0f, 8.0f};
  const auto one_side = kernel_density(points, weights, Mirror::off, 0.1f);
  EXPECT_NEAR(one_side[0], 3.0f + 4.0f * 0.75f, 1e-5f);
  EXPECT_NEAR(one_side[3], 8.0f, 1e-5f);
  const auto both = kernel_density(points, weights, Mirror::across_x, 0.1f);
  EXPECT_NEAR(both[0], one_side[0], 1e-5f);
  EXPECT_NEAR(both[3], 16.0f, 1e-5f);  // on the plane: the image is at the same place
}

TEST(MeanShift, points_that_rest_end_where_they_would_have_ended) {
  std::vector<Vec3f> points;
  std::vector<float> weights;
  for (int i = 0; i < 200; ++i) {  // two clusters of different size, so that one is at rest long before the other
    const float t = 0.1f * static_cast<float>(i);
    points.push_back((i % 2 ? 0.02f : 0.002f) * Vec3f(std::sin(t), std::cos(2.0f * t), std::sin(3.0f * t)) +
                     Vec3f(i % 2 ? 0.3f : 0.0f, 0, 0));
    weights.push_back(1.0f);
  }
  const auto all_move = mean_shift(points, weights, Mirror::off, {.bandwidth = 0.03f});
  const auto some_rest = mean_shift(points, weights, Mirror::off, {.bandwidth = 0.03f, .rest = 4e-5f});
  EXPECT_NE(some_rest.points, all_move.points);
  for (std::size_t i = 0; i < points.size(); ++i) EXPECT_VEC3_NEAR(some_rest.points[i], all_move.points[i], 1e-3f);
}

TEST(MeanShift, no_points_is_no_work) { EXPECT_TRUE(mean_shift({}, {}, Mirror::across_x, {}).points.empty()); }

}  // namespace
}  // namespace osteon::pipelines
