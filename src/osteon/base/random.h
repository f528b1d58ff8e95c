// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

namespace osteon {

// The same numbers on every machine and with every standard library (std:: distributions promise neither).
// xoshiro256++ of Blackman and Vigna, "Scrambled linear pseudorandom number generators", 2019, seeded by splitmix64.
class Random {
 public:
  explicit Random(std::uint64_t seed);

  std::uint64_t bits();
  float uniform();                            // [0, 1), 24 random bits
  float uniform(float low, float high);       // [low, high)
  float normal();                             // mean 0, variance 1 (Box-Muller)
  std::size_t below(std::size_t n);           // 0..n-1; pre: n > 0
  Random fork(std::uint64_t stream);          // an independent generator that depends on this one's state and `stream`

  template <class T>
  void shuffle(std::span<T> items) {          // Fisher-Yates
    for (std::size_t i = items.size(); i > 1; --i) std::swap(items[i - 1], items[below(i)]);
  }

 private:
  std::uint64_t state_[4];
};

}  // namespace osteon
