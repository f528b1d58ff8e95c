// SPDX-License-Identifier: Apache-2.0
#include "osteon/base/random.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

namespace osteon {
namespace {

TEST(Random, the_same_seed_gives_the_same_numbers_on_every_machine) {
  Random r(1);
  EXPECT_EQ(r.bits(), 14971601782005023387u);  // xoshiro256++ seeded by splitmix64(1)
}

TEST(Random, moments_of_uniform_and_normal) {
  Random r(7);
  double uniform_sum = 0, normal_sum = 0, normal_squares = 0;
  constexpr int n = 100000;
  for (int i = 0; i < n; ++i) {
    const double u = static_cast<double>(r.uniform()), x = static_cast<double>(r.normal());
    ASSERT_TRUE(u >= 0 && u < 1);
    uniform_sum += u;
    normal_sum += x;
    normal_squares += x * x;
  }
  EXPECT_NEAR(uniform_sum / n, 0.5, 0.005);      // standard error 0.0009
  EXPECT_NEAR(normal_sum / n, 0.0, 0.015);       // standard error 0.0032
  EXPECT_NEAR(normal_squares / n, 1.0, 0.02);    // standard error 0.0045
}

TEST(Random, shuffle_is_a_permutation_and_below_stays_below) {
  Random r(3);
  std::vector<int> items{1, 2, 3, 4, 5, 6};
  r.shuffle(std::span(items));
  EXPECT_EQ(std::set<int>(items.begin(), items.end()), (std::set<int>{1, 2, 3, 4, 5, 6}));
  for (int i = 0; i < 1000; ++i) EXPECT_LT(r.below(3), 3u);
}

}  // namespace
}  // namespace osteon
