// SPDX-License-Identifier: Apache-2.0
#include "osteon/metrics/assignment.h"

#include <cassert>
#include <limits>

namespace osteon::metrics {
namespace {

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Grows the matching row by row; pre: rows <= columns. Column `columns` stands for the row that is being added.
class Matching {
 public:
  explicit Matching(const Eigen::MatrixXd& cost)
      : cost_(cost),
        columns_(static_cast<std::size_t>(cost.cols())),
        row_potential_(static_cast<std::size_t>(cost.rows()), 0.0),
        column_potential_(columns_ + 1, 0.0),
        row_of_(columns_ + 1, kNone) {}

  void add(std::size_t row) {
    row_of_[columns_] = row;
    distance_.assign(columns_ + 1, kInfinity);
    previous_.assign(columns_ + 1, kNone);
    visited_.assign(columns_ + 1, false);
    std::size_t column = columns_;
    while (row_of_[column] != kNone) column = visit(column);
    for (; column != columns_; column = previous_[column]) row_of_[column] = row_of_[previous_[column]];
  }

  const std::vector<std::size_t>& row_of() const { return row_of_; }

 private:
  // Relaxes the columns from `column`'s row, shifts the potentials so that the nearest one becomes tight, and returns that column.
  std::size_t visit(std::size_t column) {
    visited_[column] = true;
    const std::size_t row = row_of_[column];
    std::size_t nearest = kNone;
    double step = kInfinity;
    for (std::size_t c = 0; c < columns_; ++c) {
      if (visited_[c]) continue;
      const double reduced =
          cost_(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(c)) - row_potential_[row] - column_potential_[c];
      if (reduced < distance_[c]) {
        distance_[c] = reduced;
        previous_[c] = column;
      }
      if (distance_[c] < step) {
        step = distance_[c];
        nearest = c;
      }
    }
    for (std::size_t c = 0; c <= columns_; ++c) {
      if (visited_[c]) {
        row_potential_[row_of_[c]] += step;
        column_potential_[c] -= step;
      } else {
        distance_[c] -= step;
      }
    }
    return nearest;
  }

  const Eigen::MatrixXd& cost_;
  std::size_t columns_;
  std::vector<double> row_potential_, column_potential_, distance_;
  std::vector<std::size_t> row_of_, previous_;
  std::vector<bool> visited_;
};

}  // namespace

std::vector<std::optional<std::size_t>> assign(const Matrix& cost) {
  assert(cost.allFinite());
  const bool wide = cost.rows() <= cost.cols();
  const Eigen::MatrixXd oriented = wide ? Eigen::MatrixXd(cost.cast<double>()) : Eigen::MatrixXd(cost.transpose().cast<double>());
  Matching matching(oriented);
  for (Eigen::Index row = 0; row < oriented.rows(); ++row) matching.add(static_cast<std::size_t>(row));
  std::vector<std::optional<std::size_t>> out(static_cast<std::size_t>(cost.rows()));
  for (std::size_t column = 0; column < static_cast<std::size_t>(oriented.cols()); ++column) {
    const std::size_t row = matching.row_of()[column];
    if (row == kNone) continue;
    if (wide)
      out[row] = column;
    else
      out[column] = row;
  }
  return out;
}

}  // namespace osteon::metrics
