// SPDX-License-Identifier: Apache-2.0
#include "osteon/base/random.h"

#include <bit>
#include <cassert>
#include <cmath>
#include <numbers>

namespace osteon {
namespace {

std::uint64_t splitmix64(std::uint64_t& x) {
  std::uint64_t z = (x += 0x9e3779b97f4a7c15);
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
  z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
  return z ^ (z >> 31);
}

}  // namespace

Random::Random(std::uint64_t seed) {
  for (std::uint64_t& s : state_) s = splitmix64(seed);
}

std::uint64_t Random::bits() {
  const std::uint64_t result = std::rotl(state_[0] + state_[3], 23) + state_[0];
  const std::uint64_t t = state_[1] << 17;
  state_[2] ^= state_[0];
  state_[3] ^= state_[1];
  state_[1] ^= state_[2];
  state_[0] ^= state_[3];
  state_[2] ^= t;
  state_[3] = std::rotl(state_[3], 45);
  return result;
}

float Random::uniform() { return static_cast<float>(bits() >> 40) * 0x1p-24f; }

float Random::uniform(float low, float high) { return low + (high - low) * uniform(); }

float Random::normal() {
  const float u = 1.0f - uniform();  // (0, 1]: the logarithm is finite
  return std::sqrt(-2.0f * std::log(u)) * std::cos(2.0f * std::numbers::pi_v<float> * uniform());
}

std::size_t Random::below(std::size_t n) {
  assert(n > 0);
  const std::uint64_t limit = -n % n;  // 2^64 mod n: rejecting below it leaves a multiple of n
  std::uint64_t x = bits();
  while (x < limit) x = bits();
  return x % n;
}

Random Random::fork(std::uint64_t stream) { return Random(bits() ^ (stream * 0x9e3779b97f4a7c15)); }

}  // namespace osteon
