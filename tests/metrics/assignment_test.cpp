// SPDX-License-Identifier: Apache-2.0
#include "osteon/metrics/assignment.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "osteon/base/random.h"

namespace osteon::metrics {
namespace {

double cost_of(const Matrix& cost, const std::vector<std::optional<std::size_t>>& columns) {
  double total = 0.0;
  for (std::size_t r = 0; r < columns.size(); ++r)
    if (columns[r]) total += static_cast<double>(cost(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(*columns[r])));
  return total;
}

// Tries every way to give the rows different columns; pre: rows <= columns.
double least_cost_by_trying_all(const Matrix& cost) {
  std::vector<std::size_t> columns(static_cast<std::size_t>(cost.cols()));
  std::iota(columns.begin(), columns.end(), 0);
  double best = std::numeric_limits<double>::infinity();
  do {
    double total = 0.0;
    for (Eigen::Index r = 0; r < cost.rows(); ++r)
      total += static_cast<double>(cost(r, static_cast<Eigen::Index>(columns[static_cast<std::size_t>(r)])));
    best = std::min(best, total);
  } while (std::next_permutation(columns.begin(), columns.end()));
  return best;
}

Matrix random_costs(Random& random, Eigen::Index rows, Eigen::Index columns) {
  Matrix cost(rows, columns);
  for (Eigen::Index i = 0; i < cost.size(); ++i) cost.data()[i] = random.uniform(-1.0f, 1.0f);
  return cost;
}

TEST(Assignment, costs_as_little_as_the_best_of_all_permutations) {
  Random random(3);
  for (Eigen::Index rows = 1; rows <= 6; ++rows)
    for (Eigen::Index columns = rows; columns <= 7; ++columns)
      for (int repeat = 0; repeat < 5; ++repeat) {
        const Matrix cost = random_costs(random, rows, columns);
        EXPECT_NEAR(cost_of(cost, assign(cost)), least_cost_by_trying_all(cost), 1e-5) << rows << " x " << columns;
      }
}

TEST(Assignment, gives_every_row_another_column_and_leaves_over_the_rest) {
  Random random(4);
  const Matrix tall = random_costs(random, 9, 4);
  std::vector<int> taken(4, 0);
  for (const auto& column : assign(tall))
    if (column) ++taken[*column];
  EXPECT_EQ(taken, std::vector<int>(4, 1));
}

TEST(Assignment, of_the_transposed_costs_is_the_inverse) {
  Random random(5);
  const Matrix wide = random_costs(random, 5, 8);
  const auto forth = assign(wide), back = assign(wide.transpose());
  for (std::size_t r = 0; r < forth.size(); ++r) EXPECT_EQ(back[*forth[r]], r);
}

}  // namespace
}  // namespace osteon::metrics
