// SPDX-License-Identifier: Apache-2.0
#include "osteon/metrics/score_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "osteon/base/random.h"

namespace osteon::metrics {
namespace {

ScoreTable small_table() {
  return {"skeleton",
          {{"iou", "IoU %", 100.0, 1}, {"depth", "depth", 1.0, 2}},
          {{"a", "bird", {0.5, 1.0}}, {"b", "fish", {0.7, 2.0}}, {"c", "fish", {0.9, 6.0}}},
          {"d: no joints"}};
}

TEST(Estimate, of_equal_values_has_no_width) {
  const Estimate e = estimate(std::vector<double>(20, 3.0));
  EXPECT_EQ(e.mean, 3.0);
  EXPECT_EQ(e.low, 3.0);
  EXPECT_EQ(e.high, 3.0);
}

TEST(Estimate, leaves_out_what_is_not_defined) {
  const Estimate e = estimate(std::vector<double>{1.0, std::numeric_limits<double>::quiet_NaN(), 3.0});
  EXPECT_EQ(e.mean, 2.0);
  EXPECT_EQ(e.count, 2u);
  EXPECT_TRUE(std::isnan(estimate({}).mean));
}

TEST(Estimate, of_many_normal_values_is_as_wide_as_theory_says) {
  Random random(7);
  std::vector<double> values;
  for (int i = 0; i < 400; ++i) values.push_back(static_cast<double>(random.normal()));
  const Estimate e = estimate(values);
  EXPECT_NEAR(e.high - e.low, 2.0 * 1.96 / std::sqrt(400.0), 0.02);  // the sample's own deviation and 2000 resamples: within 10 %
}

TEST(ScoreTable, shows_means_by_category_and_overall) {
  const std::string text = to_text(small_table());
  EXPECT_THAT(text, testing::HasSubstr("bird           1"));
  EXPECT_THAT(text, testing::ContainsRegex("fish +2 +80.0 +4.00"));
  EXPECT_THAT(text, testing::ContainsRegex("all +3 +70.0 +3.00"));
  EXPECT_THAT(text, testing::HasSubstr("failed: d: no joints"));
}

TEST(ScoreTable, gives_the_unscaled_values_as_json) {
  const auto json = to_json(small_table());
  EXPECT_NEAR(json["all"]["iou"]["mean"].get<double>(), 0.7, 1e-12);
  EXPECT_EQ(json["categories"]["fish"]["depth"]["mean"], 4.0);
  EXPECT_EQ(json["characters"].size(), 3u);
  EXPECT_EQ(json["failures"][0], "d: no joints");
}

}  // namespace
}  // namespace osteon::metrics
