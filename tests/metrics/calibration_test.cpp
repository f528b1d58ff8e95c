// SPDX-License-Identifier: Apache-2.0
#include "osteon/metrics/calibration.h"

#include <gtest/gtest.h>

#include <cmath>

#include "osteon/base/random.h"

namespace osteon::metrics {
namespace {

double sigmoid(double x) { return 1.0 / (1.0 + std::exp(-x)); }

// Outcomes drawn from a known law of two numbers; a third one says nothing.
std::vector<Outcome> drawn(std::size_t count) {
  Random random(3);
  std::vector<Outcome> out;
  for (std::size_t i = 0; i < count; ++i) {
    const float a = random.normal(), b = 10.0f + 3.0f * random.normal(), c = random.normal();
    const double p = sigmoid(0.5 + 1.5 * static_cast<double>(a) - 0.4 * (static_cast<double>(b) - 10.0));
    out.push_back({{a, b, c}, static_cast<double>(random.uniform()) < p ? 1.0 : 0.0, i / 10});
  }
  return out;
}

TEST(FitLogistic, finds_the_law_that_the_outcomes_were_drawn_from) {
  const LogisticFit fit = fit_logistic(drawn(20000));
  EXPECT_NEAR(fit.factors[0], 1.5, 0.08);
  EXPECT_NEAR(fit.factors[1], -0.4, 0.03);
  EXPECT_NEAR(fit.factors[2], 0.0, 0.06);
  EXPECT_NEAR(fit(std::vector{0.0f, 10.0f, 0.0f}), sigmoid(0.5), 0.02);
}

TEST(FitLogistic, leaves_out_what_speaks_against_success_where_nothing_may) {
  const LogisticFit fit = fit_logistic(drawn(20000), Factors::not_negative);
  EXPECT_GT(fit.factors[0], 1.0);
  EXPECT_EQ(fit.factors[1], 0.0);
  EXPECT_GE(fit.factors[2], 0.0);
}

TEST(FitLogistic, predicts_as_many_successes_as_there_were) {
  const auto outcomes = drawn(300);
  const LogisticFit fit = fit_logistic(outcomes);
  double predicted = 0.0, happened = 0.0;
  for (const Outcome& outcome : outcomes) {
    predicted += fit(outcome.evidence);
    happened += outcome.success;
  }
  EXPECT_NEAR(predicted, happened, 1e-3);  // the bias is not held back
}

TEST(FitLogistic, of_evidence_that_never_changes_is_the_mean) {
  const std::vector<Outcome> outcomes{{{2.0f}, 1.0, 0}, {{2.0f}, 0.0, 1}, {{2.0f}, 1.0, 2}, {{2.0f}, 1.0, 3}};
  EXPECT_NEAR(fit_logistic(outcomes)(std::vector{2.0f}), 0.75, 1e-5);
}

TEST(FitLogistic, stays_finite_where_all_is_certain) {
  const std::vector<Outcome> outcomes{{{0.0f}, 1.0, 0}, {{1.0f}, 1.0, 1}};
  const double p = fit_logistic(outcomes)(std::vector{0.5f});
  EXPECT_GT(p, 0.9);
  EXPECT_LE(p, 1.0);
}

TEST(CrossValidated, does_not_hear_the_group_itself) {
  // Two groups that contradict one another: each is predicted as the other is.
  const std::vector<Outcome> outcomes{{{0.0f}, 1.0, 0}, {{0.0f}, 1.0, 0}, {{0.0f}, 0.0, 1}, {{0.0f}, 0.0, 1}};
  const auto predicted = cross_validated(outcomes);
  EXPECT_LT(predicted[0], 0.1);
  EXPECT_GT(predicted[2], 0.9);
}

TEST(Reliability, sorts_into_bins_and_keeps_both_ends) {
  const auto bins = reliability(std::vector{0.0, 0.05, 0.95, 1.0}, std::vector{0.0, 1.0, 1.0, 1.0});
  ASSERT_EQ(bins.size(), 10u);
  EXPECT_EQ(bins.front().count, 2u);
  EXPECT_DOUBLE_EQ(bins.front().success, 0.5);
  EXPECT_EQ(bins.back().count, 2u);
  EXPECT_DOUBLE_EQ(bins.back().predicted, 0.975);
  EXPECT_TRUE(std::isnan(bins[4].success));
}

TEST(CalibrationError, is_the_mean_difference_over_all_outcomes) {
  const std::vector<ReliabilityBin> bins{{0.2, 0.3, 3}, {0.9, 0.5, 1}, {std::nan(""), std::nan(""), 0}};
  EXPECT_DOUBLE_EQ(calibration_error(bins), (3 * 0.1 + 0.4) / 4);
}

}  // namespace
}  // namespace osteon::metrics
