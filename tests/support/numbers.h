// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstring>
#include <limits>
#include <span>
#include <vector>

#include "osteon/base/parallel.h"
#include "osteon/base/random.h"
#include "osteon/base/types.h"

namespace osteon::test {

// Normally distributed numbers, times `scale`.
inline Matrix random_matrix(std::size_t rows, std::size_t columns, Random& random, float scale = 1) {
  Matrix out(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns));
  for (float& x : out.reshaped()) x = scale * random.normal();
  return out;
}

inline std::vector<float> random_floats(std::size_t count, Random& random, float scale = 1) {
  std::vector<float> out(count);
  for (float& x : out) x = scale * random.normal();
  return out;
}

inline double mean(std::span<const double> values) {
  double sum = 0.0;
  for (const double v : values) sum += v;
  return sum / static_cast<double>(values.size());
}

// The largest difference, as a share of the largest number. Infinite if the shapes differ or anything is not finite.
inline float relative_difference(const Matrix& a, const Matrix& b) {
  if (a.rows() != b.rows() || a.cols() != b.cols() || !a.allFinite() || !b.allFinite()) return std::numeric_limits<float>::infinity();
  if (a.size() == 0) return 0;
  return (a - b).cwiseAbs().maxCoeff() / std::max(1e-30f, b.cwiseAbs().maxCoeff());
}

inline bool same_bits(const Matrix& a, const Matrix& b) {
  return a.rows() == b.rows() && a.cols() == b.cols() &&
         std::memcmp(a.data(), b.data(), static_cast<std::size_t>(a.size()) * sizeof(float)) == 0;
}

// Sets the thread count for a scope.
class ScopedThreads {
 public:
  explicit ScopedThreads(int n) : before_(threads()) { set_threads(n); }
  ~ScopedThreads() { set_threads(before_); }
  ScopedThreads(const ScopedThreads&) = delete;
  ScopedThreads& operator=(const ScopedThreads&) = delete;

 private:
  int before_;
};

}  // namespace osteon::test
