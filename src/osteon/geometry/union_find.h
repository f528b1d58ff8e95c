// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

namespace osteon::geometry {

// Sets of 0..n-1 that can be joined; each is named by its smallest member, so that nothing depends on the order of joining.
class UnionFind {
 public:
  explicit UnionFind(std::size_t n) : parents_(n) { std::iota(parents_.begin(), parents_.end(), 0u); }

  std::uint32_t find(std::uint32_t i) {
    while (parents_[i] != i) i = parents_[i] = parents_[parents_[i]];  // path halving
    return i;
  }
  bool join(std::uint32_t a, std::uint32_t b) {  // whether they were apart
    a = find(a), b = find(b);
    parents_[std::max(a, b)] = std::min(a, b);
    return a != b;
  }
  std::vector<std::uint32_t> all() {  // of each its set
    std::vector<std::uint32_t> out(parents_.size());
    for (std::uint32_t i = 0; i < out.size(); ++i) out[i] = find(i);
    return out;
  }

 private:
  std::vector<std::uint32_t> parents_;
};

}  // namespace osteon::geometry
